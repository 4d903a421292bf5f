"""The tables: their errors against the functions they stand for, through the datapath's own lookups."""

from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from integer_objects import MATERIALS

from golden.datapath import records
from golden.datapath.edge import damper, interpolate_inverse
from golden.datapath.formats import Formats
from golden.datapath.tables import Tables, damper_table, inverse_table, octave, octave_inverse
from golden.numbers.block import magnitude
from golden.numbers.qarray import QArray
from golden.physics.materials import PRESETS
from sim.encode.coefficients import coefficients
from sim.encode.encode import stack
from sim.encode.units import Units

FMT = Formats()


def number(raw, q, faults=None):
    return QArray(np.asarray(raw, np.int64), q, faults)


@pytest.mark.parametrize(("operand", "state"), [(12, 24), (16, 32), (18, 36), (20, 40), (22, 44)])
def test_the_inverse_square_root_of_every_operand_is_within_its_bound(operand, state):
    """A line half-way between chord and curve is h^2 f'' / 16 off at most, f'' = 3/4 at q = 1; to that come half of a
    last place of the value, of the slope and of the result. At q = 1 the result, 1, is a last place too large; and
    the first segment's line starts by half a last place of the result lower, not to come there."""
    fmt = Formats(operand, state)
    faults = Counter()
    q = number(np.arange(1 << operand - 2, 1 << operand), fmt.square, faults)
    result = interpolate_inverse(fmt, Tables(fmt, inverse_table(fmt), {}), q)
    error = np.abs(result.to_float() - q.to_float() ** -0.5)
    segment = 4 / len(inverse_table(fmt)["value"])
    bound = segment**2 * 0.75 / 16 + (fmt.inverse_value.lsb + fmt.inverse_slope.lsb + fmt.inverse.lsb) / 2
    first = q.to_float() < 1 + segment
    largest = error[~first].max()
    print(f"{operand} bits: error {largest:.3g}, 2^{np.log2(largest):.2f}, bound {bound:.3g}")
    assert bound / 3 < largest <= bound
    assert error[first].max() <= bound + fmt.inverse.lsb / 2 + fmt.inverse_value.lsb
    assert not faults


def test_a_square_below_one_reads_the_value_of_one():
    """Only an edge without length gets there, which is a fault; the table's word must do no harm."""
    table = inverse_table(FMT)
    below = len(table["value"]) // 4
    assert (table["value"][:below] == FMT.inverse_value.raw_max).all()
    assert (table["slope"][:below] == 0).all()


# Branches narrow and wide, c2 falling by a tenth and by five decades, c1 far above, between and far below
DAMPERS = {
    **{name: MATERIALS[name] for name in ("rheological-force", "plastic-force")},
    "narrow": PRESETS["rheological-force"]("narrow", 2000.0, 30.0, f1=0.4, f2=0.41, c_max=300.0, c_min=3.0),
    "clay": PRESETS["rheological-force"]("clay", 2000.0, 3.0, f1=0.4, f2=1.2, c_max=8000.0, c_min=40.0),
    "wide": PRESETS["plastic-force"]("wide", 50.0, f1=0.05, f2=0.5, c_max=10.0, c_min=0.05),
    "stiff": PRESETS["plastic-force"]("stiff", 500.0, f1=0.1, f2=0.5, c_max=1.0, c_min=0.05),
    "slight": PRESETS["rheological-force"]("slight", 200.0, 0.5, f1=0.05, f2=0.5, c_max=1.0, c_min=0.9),
}
SEGMENTS = 1 << FMT.damper_index.width


class Lookup:
    """The lookup of rho and sigma (m/N s) of a material at trial forces (N), by the datapath's own functions."""

    def __init__(self, material):
        self.material = m = material
        self.g1, self.g2 = m.knees
        self.full = 2.0 ** np.ceil(np.log2(self.g2))
        self.units = Units(size=0.1, centre=None, dt=2e-4, velocity_shift=9, force=4.0, trial=(self.full,))
        self.record, self.table = coefficients(m, 0, self.units, FMT, 0)
        self.faults = Counter()

    def __call__(self, g):
        """Return (|g| as the datapath has it, rho, sigma)."""
        trial = number(np.ldexp(g / self.full, FMT.trial.frac_bits), FMT.trial + FMT.trial, self.faults)
        size, mantissa, shift = magnitude(trial, FMT.operand)
        tables = Tables(FMT, inverse_table(FMT), stack([self.table.words], FMT))
        record = {name: number(self.record[name], q, self.faults) for name, q in records.material(FMT, 1).items()}
        got = damper(FMT, tables, SimpleNamespace(**record), size, mantissa, shift)
        rho = np.ldexp(got["rho"].to_float(), -got["rho_shift"].raw)
        creep = np.ldexp(got["sigma"].to_float(), -(got["sigma_shift"].raw + self.record["creep_shift"]))
        return size.to_float() * self.full, rho, creep * self.units.velocity / (2 * self.full)

    def everywhere(self):
        """Return trial forces over the whole range, inside every segment, and close to both kinks."""
        around = 1 + np.linspace(-1e-3, 1e-3, 2001)
        wide = np.geomspace(self.g1 / 100, 1.99 * self.full, 20_000)
        inside = np.geomspace(self.g1, self.g2, 40 * SEGMENTS)
        return np.concatenate([wide, inside, self.g1 * around, self.g2 * around])


@pytest.mark.parametrize("name", DAMPERS)
def test_the_damper_is_that_of_the_exact_law_to_a_ten_thousandth(name):
    m, lookup = DAMPERS[name], Lookup(DAMPERS[name])
    g, rho, sigma = lookup(lookup.everywhere())
    exact_rho, exact_sigma = m.rho_sigma(g)
    errors = np.abs(rho / exact_rho - 1), np.abs(sigma / exact_sigma - 1)
    print(
        f"{name}: largest relative error of rho {errors[0].max():.2g}, of sigma {errors[1].max():.2g}; "
        f"mean {errors[0].mean():.2g}, {errors[1].mean():.2g}"
    )
    assert max(error.max() for error in errors) <= 1e-4
    assert not lookup.faults


@pytest.mark.parametrize("name", DAMPERS)
def test_outside_the_branch_the_constants_are_exact(name):
    """They come from the record, not from the table, so they are exact."""
    lookup = Lookup(DAMPERS[name])
    threshold = FMT.threshold.lsb * lookup.full
    record = lookup.record
    for end, g in (
        ("low", np.array([0.0, lookup.g1 / 7, lookup.record["g1"] * threshold - threshold])),
        ("high", np.array([lookup.record["g2"] * threshold, lookup.g2 * 1.01, 1.99 * lookup.full])),
    ):
        _, rho, sigma = lookup(g)
        assert (rho == np.ldexp(FMT.mantissa.lsb * record[f"rho_{end}"], -record[f"rho_{end}_shift"])).all()
        creep = np.ldexp(
            FMT.mantissa.lsb * record[f"sigma_{end}"], -(record[f"sigma_{end}_shift"] + record["creep_shift"])
        )
        np.testing.assert_allclose(sigma, creep * lookup.units.velocity / (2 * lookup.full), rtol=1e-15)
    assert record["g1"] == round(lookup.g1 / threshold) and record["g2"] == round(lookup.g2 / threshold)


def straight(words, name, sign, segment, fraction):
    """Return the line that a segment's word describes."""
    value, slope, shift = (words[f"{name}_{part}"][segment] for part in ("value", "slope", "shift"))
    return np.ldexp(FMT.damper_value.lsb * value + sign * FMT.damper_slope.lsb * slope * fraction, -shift)


@pytest.mark.parametrize("name", DAMPERS)
def test_no_segment_contains_a_kink(name):
    """The line of a segment with an end of the branch in it is near the smooth continuation all along the segment."""
    lookup, fraction = Lookup(DAMPERS[name]), np.linspace(0, 1, 21)
    table, finest = lookup.table, 1 << FMT.octave.frac_bits
    places = (table.first_octave + np.arange(SEGMENTS + 1) * finest // 2**table.fineness) / finest
    for g in (lookup.g1, lookup.g2):
        segment = int(np.searchsorted(places, octave(g / lookup.full), side="right")) - 1
        assert 0 <= segment < SEGMENTS
        start, end = lookup.full * octave_inverse(places[segment : segment + 2])
        rho, sigma = lookup.material.damper.middle_rho_sigma(lookup.material.c1, start + fraction * (end - start))
        np.testing.assert_allclose(straight(table.words, "rho", -1, segment, fraction), rho, rtol=1e-4)
        creep = straight(table.words, "sigma", 1, segment, fraction) * 2.0 ** -lookup.record["creep_shift"]
        np.testing.assert_allclose(creep * lookup.units.velocity / (2 * lookup.full), sigma, rtol=1e-4)


def test_octaves_are_exponent_and_mantissa():
    x = np.array([0.375, 1.0, 1.5, 2.0, 3.0, 4.0, 96.0])
    assert octave(x).tolist() == [-1.5, 0.0, 0.5, 1.0, 1.5, 2.0, 6.5]
    assert octave_inverse(octave(x)).tolist() == x.tolist()


@pytest.mark.parametrize(
    ("octaves", "per_octave"), [(0.9, 512), (1, 256), (1.9, 256), (3, 128), (4, 64), (15, 32), (18, 16)]
)
def test_the_finest_segments_that_cover_a_branch_are_taken(octaves, per_octave):
    table = damper_table(FMT, 2.0**-octaves, 1.0, rho=np.ones_like, sigma=np.ones_like)
    assert 2**table.fineness == per_octave
    first, last = octave(2.0**-octaves), octave(1.0)
    start = table.first_octave * FMT.octave.lsb
    assert start <= first < start + 1 / per_octave and last < start + SEGMENTS / per_octave


def test_a_branch_that_starts_too_low_is_refused():
    with pytest.raises(ValueError, match=r"^g1 must be at least 3\.8147e-06 of the trial force's full scale, not"):
        damper_table(FMT, 1e-6, 1.0, rho=np.ones_like, sigma=np.ones_like)


@pytest.mark.parametrize("name", ["rho", "sigma"])
def test_a_branch_too_steep_for_a_segment_is_refused(name):
    curves = {"rho": np.ones_like, "sigma": np.ones_like, name: lambda g: np.where(g < 0.7, 0.25, 1.0)}
    with pytest.raises(ValueError, match=f"^{name} must change by less than 1/8 of itself in a segment, not 0.75$"):
        damper_table(FMT, 0.5, 1.0, **curves)
