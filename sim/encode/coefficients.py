"""A material in the circuit's units: the fields of `golden.datapath.records.material` and its damper table."""

from functools import partial
from math import log2

import numpy as np

from golden.datapath.formats import Formats
from golden.datapath.tables import DamperTable, damper_table
from golden.physics.materials import Material
from golden.support.errors import InputError
from sim.encode.units import Units


def coefficient(x: float, formats: Formats) -> tuple[int, int]:
    """``(raw mantissa, shift)`` of ``x = mantissa * 2**-shift`` with the mantissa in [1/2, 1)."""
    mantissa, exponent = np.frexp(x)
    raw = int(np.floor(np.ldexp(mantissa, formats.mantissa.frac_bits) + 0.5))
    if raw > formats.mantissa.raw_max:
        raw, exponent = raw >> 1, exponent + 1
    return raw, -int(exponent)


def middle_branch(material: Material, g: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(rho, sigma) of equation (7)'s middle branch, continued past both ends: bisection on f (1 + c1 / c2) = |g|."""
    b = np.log(material.c_max / material.c_min) / (material.f2 - material.f1)

    def c2(f):
        return material.c_max * np.exp(-b * (f - material.f1))

    low, high = np.zeros_like(g), g.copy()
    with np.errstate(over="ignore", divide="ignore"):
        for _ in range(100):
            f = (low + high) / 2
            above = f * (1 + material.c1 / c2(f)) > g
            low, high = np.where(above, low, f), np.where(above, f, high)
    total = material.c1 + c2(low)
    return c2(low) / total, 1 / total


def coefficients(
    material: Material, number: int, units: Units, formats: Formats, table: int
) -> tuple[dict[str, int], DamperTable | None]:
    """The record of material ``number`` of the scene, and its damper table unless the damper is linear.

    Raises
    ------
    InputError
        If the force-dependent branch is out of the range of the trial force's format.
    """
    full = units.trial[number]
    ends = {}
    for end, c2 in (("low", material.c_max), ("high", material.c_min)):
        ends[end] = 1 / (1 + material.c1 / c2), 1 / (material.c1 + c2)
    # |g| = 2 g 2^-g_shift full scales; the creep rate in velocity full scales
    creep = 2 * full / units.velocity
    creep_shift = coefficient(creep * ends["high"][1], formats)[1]
    largest = formats.threshold.raw_max * formats.threshold.lsb
    g1, g2 = (
        min(f * (1 + material.c1 / c) / full, largest)
        for f, c in ((material.f1, material.c_max), (material.f2, material.c_min))
    )

    words = None
    if g1 < largest:
        branch = partial(middle_branch, material)
        try:
            words = damper_table(
                formats,
                g1,
                g2,
                rho=lambda g: branch(g * full)[0],
                sigma=lambda g: np.ldexp(creep * branch(g * full)[1], creep_shift),
            )
        except ValueError as error:
            raise InputError(
                f"materials.{material.name}.f1 and f2 must give a branch that the damper table holds "
                f"(a larger f1, a longer way to f2, or c_max nearer to c_min would do): {error}"
            ) from None

    k, k_shift = coefficient(material.k * units.size / full, formats)
    c, c_shift = coefficient(material.c1 * units.velocity / full, formats)
    record = {
        "k": k,
        "k_shift": k_shift,
        "c": c,
        "c_shift": c_shift,
        "a_min": ratio(material.a_min, formats),
        "a_max": ratio(material.a_max, formats),
        "g1": round(g1 / formats.threshold.lsb),
        "g2": round(g2 / formats.threshold.lsb),
        "force_shift": round(log2(units.force / full)) - 1,
        "creep_shift": creep_shift,
        "first_octave": words.first_octave if words else 0,
        "fineness": words.fineness if words else 0,
        "table": table if words else 0,
    }
    for end, (rho, sigma) in ends.items():
        record[f"rho_{end}"], record[f"rho_{end}_shift"] = coefficient(rho, formats)
        value, shift = coefficient(creep * sigma, formats)
        record[f"sigma_{end}"], record[f"sigma_{end}_shift"] = value, shift - creep_shift if value else 0
    return record, words


def ratio(a: float, formats: Formats) -> int:
    return round(a * 2**formats.ratio.frac_bits)
