"""A material in the circuit's units: the fields of `golden.datapath.records.material` and its damper table."""

from functools import partial
from math import inf, log2

import numpy as np

from golden.datapath.formats import Formats
from golden.datapath.tables import DamperTable, damper_table
from golden.physics.materials import Material
from golden.support.errors import InputError
from sim.encode.units import Units


def coefficient(x: float, formats: Formats) -> tuple[int, int]:
    """Return ``(raw mantissa, shift)`` of ``x = mantissa * 2**-shift`` with the mantissa in [1/2, 1)."""
    mantissa, exponent = np.frexp(x)
    raw = (formats.mantissa + formats.mantissa).quantise(mantissa)
    if raw > formats.mantissa.raw_max:
        raw, exponent = raw >> 1, exponent + 1
    return raw, -int(exponent)


def coefficients(
    material: Material, number: int, units: Units, formats: Formats, table: int
) -> tuple[dict[str, int], DamperTable | None]:
    """Return the record of material ``number`` of the scene, and its damper table unless the damper is linear.

    Raises
    ------
    InputError
        If the force-dependent branch is out of the range of the trial force's format.
    """
    full = units.trial[number]
    ends = {"low": material.rho_sigma(0.0), "high": material.rho_sigma(inf)}
    # |g| = 2 g 2^-g_shift full scales; the creep rate in velocity full scales
    creep = 2 * full / units.velocity
    creep_shift = coefficient(creep * ends["high"][1], formats)[1]
    largest = formats.threshold.raw_max * formats.threshold.lsb
    g1, g2 = (min(g / full, largest) for g in material.knees)

    words = None
    if g1 < largest:
        branch = partial(material.damper.middle_rho_sigma, material.c1)
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
        "a_min": formats.ratio.quantise(material.a_min),
        "a_max": formats.ratio.quantise(material.a_max),
        "g1": formats.threshold.quantise(g1),
        "g2": formats.threshold.quantise(g2),
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
