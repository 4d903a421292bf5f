"""The algebra of widths: what a format holds, and that the operators' formats hold their results."""

import itertools
import operator
from fractions import Fraction
from math import floor

import numpy as np
import pytest
from small_formats import every_pair, outside, small_formats

from golden.numbers.qformat import BIT, Q, count, round_half_up, smallest, unsigned

FORMATS = small_formats(range(1, 5), range(-1, 4))
OPERATORS = operator.add, operator.sub, operator.mul


def extremes(q):
    step = Fraction(2) ** -q.frac_bits
    return q.raw_min * step, q.raw_max * step


def holds(q, values):
    low, high = extremes(q)
    step = Fraction(2) ** -q.frac_bits
    return low <= min(values) and max(values) <= high and all(value % step == 0 for value in values)


@pytest.mark.parametrize(
    ("q", "width", "low", "high", "lsb", "text"),
    [
        (Q(1, 17), 18, -(2**17), 2**17 - 1, 2.0**-17, "Q1.17"),
        (Q(0, 18, signed=False), 18, 0, 2**18 - 1, 2.0**-18, "UQ0.18"),
        (Q(3, -2), 1, -1, 0, 4.0, "Q3.-2"),
        (unsigned(-8, 24), 16, 0, 2**16 - 1, 2.0**-24, "UQ-8.24"),
        (BIT, 1, 0, 1, 1.0, "UQ1.0"),
    ],
)
def test_a_format_is_what_it_says(q, width, low, high, lsb, text):
    assert (q.width, q.raw_min, q.raw_max, q.lsb, str(q)) == (width, low, high, lsb, text)


@pytest.mark.parametrize(("int_bits", "frac_bits"), [(0, 0), (3, -3), (-2, 1)])
def test_a_format_without_bits_is_refused(int_bits, frac_bits):
    with pytest.raises(ValueError, match=r"^a format must have at least 1 bit, not -?\d \(Q"):
        Q(int_bits, frac_bits)


def test_formats_are_equal_by_what_they_hold_and_are_called():
    assert Q(1, 17) == Q(1, 17) and hash(Q(1, 17)) == hash(Q(1, 17))
    assert len({Q(1, 17), Q(2, 16), Q(1, 17, signed=False), Q(1, 17, name="force")}) == 4


@pytest.mark.parametrize("operation", OPERATORS)
def test_operators_give_formats_that_hold_every_result(operation):
    for a, b in itertools.product(FORMATS, FORMATS):
        results = [operation(x, y) for x in extremes(a) for y in extremes(b)]  # extremes are at the corners
        assert holds(operation(a, b), results), (a, b)


@pytest.mark.parametrize("operation", OPERATORS)
def test_formats_of_results_are_those_of_apytypes(operation):
    signed = [q for q in FORMATS if q.signed]
    for a, b in itertools.product(signed, signed):
        theirs = operation(*map(outside, every_pair(a, b)))
        ours = operation(a, b)
        assert (ours.int_bits, ours.frac_bits) == (theirs.int_bits, theirs.frac_bits), (a, b)


def test_a_union_holds_both_and_nothing_smaller_does():
    for a, b in itertools.product(FORMATS, FORMATS):
        both = a.union(b)
        values = [*extremes(a), *extremes(b)]
        assert holds(both, values) and both == b.union(a)
        if a.width > 1 and b.width > 1:
            assert not holds(Q(both.int_bits - 1, both.frac_bits, both.signed), values)


def test_magnitude_and_scale_give_their_formats():
    for q in FORMATS:
        low, high = extremes(q)
        assert holds(abs(q), [abs(low), abs(high)]) and not abs(q).signed
        for power in (-3, 0, 2):
            assert extremes(q.scale(power)) == (low * Fraction(2) ** power, high * Fraction(2) ** power)


@pytest.mark.parametrize("raw", range(-9, 10))
def test_the_smallest_format_of_an_integer(raw):
    q = smallest(raw)
    assert q.raw_min <= raw <= q.raw_max and q.frac_bits == 0
    assert q.width == 1 or not Q(q.width - 1, 0, q.signed).raw_min <= raw <= Q(q.width - 1, 0, q.signed).raw_max


@pytest.mark.parametrize(("most", "width"), [(1, 1), (7, 3), (8, 4), (19, 5)])
def test_the_format_of_a_count_holds_the_most(most, width):
    assert count(most) == unsigned(width, 0)


QUARTERS = Q(1, 2, name="ratio", unit="size")
HALF_UP = [(-1.0, -4), (-0.376, -2), (-0.375, -1), (-0.125, 0), (0.1, 0), (0.125, 1), (0.375, 2), (0.625, 3), (0.75, 3)]


@pytest.mark.parametrize(("value", "raw"), HALF_UP)
def test_quantise_takes_the_nearest_integer_half_up(value, raw):
    assert QUARTERS.quantise(value) == raw and isinstance(QUARTERS.quantise(value), int)


def test_quantise_makes_int64_arrays_of_arrays():
    values, expected = zip(*HALF_UP, strict=True)
    raw = QUARTERS.quantise(np.reshape(values, (3, 3)))
    assert raw.dtype == np.int64 and raw.tolist() == np.reshape(expected, (3, 3)).tolist()
    np.testing.assert_array_equal(QUARTERS.to_float(raw), raw / 4)


def test_just_below_a_half_is_rounded_down():
    """Adding a half to it in float64 would give 1."""
    assert Q(4, 0).quantise(np.nextafter(0.5, 0)) == 0


@pytest.mark.parametrize("value", [0.875, -1.126, 3.0, np.inf, np.nan])
def test_quantise_refuses_what_does_not_fit_naming_the_quantity(value):
    with pytest.raises(ValueError, match=rf"^ratio must be within -1 and 0\.75 size, not {value:g}$"):
        QUARTERS.quantise([0.0, value])
    with pytest.raises(ValueError, match=rf"^Q1\.2 must be within -1 and 0\.75, not {value:g}$"):
        Q(1, 2).quantise(value)


def test_quantise_may_saturate():
    assert QUARTERS.quantise([-7.0, 0.875, 0.5, np.inf], saturate=True).tolist() == [-4, 3, 2, 3]
    with pytest.raises(ValueError, match="ratio must be within"):
        QUARTERS.quantise([np.nan], saturate=True)


@pytest.mark.parametrize("q", [Q(3, 0), unsigned(2, 1), BIT, Q(-1, 4)])
def test_bits_are_the_integer_they_stand_for(q):
    for raw in range(q.raw_min, q.raw_max + 1):
        for above in (0, 1, 5):
            assert q.from_bits((raw & (1 << q.width) - 1) | above << q.width) == raw


@pytest.mark.parametrize("drop", range(5))
def test_integers_are_rounded_half_up(drop):
    raw = np.arange(-40, 41)
    expected = [floor(Fraction(int(x), 1 << drop) + Fraction(1, 2)) for x in raw]
    assert round_half_up(raw, drop).tolist() == [round_half_up(int(x), drop) for x in raw] == expected
    widest = 2**62 - 1
    for end in (widest, -widest - 1):
        assert int(round_half_up(np.int64(end), drop)) == round_half_up(end, drop)
