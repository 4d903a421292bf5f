"""The integer arithmetic against apytypes and exact fractions, every operand of every small format."""

import itertools
import operator
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
from apytypes import OverflowMode, QuantizationMode
from small_formats import every, every_pair, outside, same, small_formats

from golden.numbers.qarray import QArray
from golden.numbers.qformat import BIT, Q, count, unsigned

FORMATS = small_formats(range(1, 5), range(-1, 4))


@pytest.mark.parametrize("operation", [operator.add, operator.sub, operator.mul])
def test_sums_and_products_are_those_of_apytypes(operation):
    for a, b in itertools.product(FORMATS, FORMATS):
        x, y = every_pair(a, b)
        result = operation(x, y)
        assert same(result, operation(outside(x), outside(y))), (a, b)
        assert result.fmt == operation(a, b)
        assert result.fmt.raw_min <= result.raw.min() and result.raw.max() <= result.fmt.raw_max


@pytest.mark.parametrize("number", range(-9, 10))
def test_integers_are_numbers_too(number):
    for q in FORMATS:
        x = QArray(every(q), q, None)
        for result, exact in (
            (x + number, x.to_float() + number),
            (number + x, x.to_float() + number),
            (x - number, x.to_float() - number),
            (number - x, number - x.to_float()),
        ):
            assert np.array_equal(result.to_float(), exact), q
        assert np.array_equal((x < number).raw, x.to_float() < number)


def test_comparison_magnitude_and_choice_are_exact():
    for a, b in itertools.product(FORMATS, FORMATS):
        x, y = every_pair(a, b)
        less = x < y
        assert less.fmt == BIT
        assert np.array_equal(less.raw, x.to_float() < y.to_float())
        lower = less.select(x, y)
        assert lower.fmt == a.union(b)
        assert np.array_equal(lower.to_float(), np.minimum(x.to_float(), y.to_float()))
    for q in FORMATS:
        x = QArray(every(q), q, None)
        size = abs(x)
        assert size.fmt == abs(q) and size.raw.max() <= size.fmt.raw_max
        assert np.array_equal(size.to_float(), np.abs(x.to_float()))


def test_a_zero_to_choose_takes_no_bits():
    bit = QArray(np.array([1, 0]), BIT, None)
    x = QArray(np.array([3, 3]), Q(-2, 6), None)
    assert bit.select(0, x).fmt == bit.select(x, 0).fmt == x.fmt
    assert bit.select(0, x).raw.tolist() == [0, 3] and bit.select(x, 0).raw.tolist() == [3, 0]
    assert bit.select(2, 0).raw.tolist() == [2, 0]


def test_rounding_and_saturation_are_those_of_apytypes():
    """RND is half up, SAT is to the nearest end: for all numbers, between all pairs of formats."""
    mode = dict(quantization=QuantizationMode.TIES_POS, overflow=OverflowMode.SAT)
    targets = small_formats(range(1, 4), range(-1, 3))
    for q, target in itertools.product(small_formats([1, 2, 5, 6], range(-1, 4)), targets):
        x = QArray(every(q), q, Counter())
        result = x.to(target)
        assert result.fmt == target
        theirs = outside(x)
        if not target.signed:  # what is negative saturates at 0, which a signed format can't say
            theirs = outside(QArray(np.maximum(x.raw, 0), q, None))
        theirs = theirs.cast(int_bits=target.int_bits + (not target.signed), frac_bits=target.frac_bits, **mode)
        assert same(result, theirs), (q, target)


def half_up(value: Fraction, target: Q) -> int:
    """Return the exact value in LSBs of the target, rounded half up."""
    scaled = value * Fraction(2) ** target.frac_bits + Fraction(1, 2)
    return scaled.numerator // scaled.denominator


def check(x: QArray, target: Q, power, result: QArray, beyond=()):
    """Compare ``x * 2**power`` in ``target`` with its exact fraction, and the faults with the rule in `QArray.to`."""
    faults = 0
    for number, (raw, p, got) in enumerate(np.nditer([x.raw, power, result.raw])):
        exact = Fraction(int(raw)) * Fraction(2) ** (int(p) - x.fmt.frac_bits)
        rounded = half_up(exact, target)
        places = exact * Fraction(2) ** target.frac_bits
        if number in beyond:
            expected, fault = target.raw_min if raw < 0 else target.raw_max, True
        else:
            expected = min(max(rounded, target.raw_min), target.raw_max)
            fault = places >= target.raw_max + 1 or rounded < target.raw_min
        assert got == expected, (x.fmt, target, raw, p)
        faults += fault
    assert x.faults == (Counter({target.name: faults}) if faults else Counter())


TARGETS = [Q(q.int_bits, q.frac_bits, q.signed, "quantity") for q in small_formats([1, 3], [-1, 1])]


@pytest.mark.parametrize("q", small_formats([1, 4, 5], [0, 2]), ids=str)
def test_rounding_is_exact_and_its_faults_are_those_of_the_rule(q):
    for target in TARGETS:
        x = QArray(every(q), q, Counter())
        check(x, target, np.zeros(1, int), x.to(target))


@pytest.mark.parametrize("q", small_formats([1, 4, 5], [0, 2]), ids=str)
def test_shifts_to_the_right_are_exact_and_one_to_the_left_is_a_fault(q):
    shift = Q(8, 0)
    for target in TARGETS:
        raw, right = (grid.ravel() for grid in np.meshgrid(every(q), [*range(-3, 9), 60, 61, 62, 63, 64, 127, -128]))
        x = QArray(raw, q, Counter())
        result = x.to(target, right=QArray(right, shift, x.faults))
        beyond = set(np.flatnonzero((right < 0) & (raw != 0)))
        check(x, target, -np.maximum(right, 0), result, beyond)


def test_shifts_of_the_widest_numbers_are_exact():
    q, target = Q(3, 59), Q(1, 12, name="quantity")
    corners = [q.raw_min, q.raw_min + 1, -1, 0, 1, q.raw_max - 1, q.raw_max, q.raw_max // 3]
    raw, right = (grid.ravel() for grid in np.meshgrid(corners, [0, 1, 2, 3, 30, 61, 62, 63, 100]))
    x = QArray(raw, q, Counter())
    check(x, target, -right, x.to(target, right=QArray(right, Q(8, 0), x.faults)))


def test_shifts_to_the_left_are_exact_as_far_as_lead_says():
    for q in small_formats([1, 4, 6], [0, 2]):
        raw, left = (grid.ravel() for grid in np.meshgrid(every(q), range(6)))
        x = QArray(raw, q, Counter())
        possible = left <= QArray.lead([x], 6).raw
        x.raw, left = raw[possible], left[possible]
        for target in TARGETS:
            x.faults.clear()
            check(x, target, left, x.to(target, left=QArray(left, count(6), x.faults)))


def test_a_format_without_a_name_saturates_without_a_word():
    x = QArray(every(Q(4, 0)), Q(4, 0), Counter())
    assert x.to(Q(2, 0)).raw.tolist() == [-2] * 7 + [-1, 0, 1] + [1] * 6
    assert not x.faults


def test_lead_counts_how_far_a_vector_can_be_shifted():
    for q in small_formats([1, 4], [0, 2]):
        for most in (1, 2, 5):
            x, y = every_pair(q, q)
            got = QArray.lead([x, y], most)
            assert got.fmt == count(most)
            for a, b, shift in zip(x.raw, y.raw, got.raw, strict=True):
                fits = [s for s in range(most + 1) if all(q.raw_min <= n << s <= q.raw_max for n in (a, b))]
                possible = q.width - q.signed if a == b == 0 else max(fits)
                assert shift == min(possible, most), (q, a, b)


@pytest.mark.parametrize("width", [53, 54, 60, 63])
def test_lead_is_exact_for_the_widest_numbers(width):
    """float64 rounds 2**54 - 1 up to one bit more."""
    q = Q(1, width - 1)
    for bits in range(width):
        values = [2**bits - 1, -(2**bits), 2 ** max(bits - 1, 0)]
        shifts = QArray.lead([QArray(np.array(values), q, None)], 63).raw
        assert shifts.tolist() == [width - 1 - bits, width - 1 - bits, width - 1 - max(bits, 1)]


def test_field_reads_bits_of_the_integer():
    for q in small_formats([4, 6], [0, 2]):
        x = QArray(every(q), q, None)
        for low, width in itertools.product(range(3), (1, 2)):
            got = x.field(low, unsigned(0, width))
            assert got.fmt == unsigned(0, width)
            bits = [format(int(raw) % 2**q.width, f"0{q.width}b") for raw in x.raw]
            assert got.raw.tolist() == [int(text[q.width - low - width : q.width - low], 2) for text in bits]


def test_a_field_with_a_sign_is_what_is_left_of_the_number():
    x = QArray(every(Q(2, 4)), Q(2, 4), None)
    assert x.field(1, Q(2, 3)).raw.tolist() == (x.raw // 2).tolist()
    assert x.field(0, Q(1, 1)).raw.tolist() == ((x.raw + 2) % 4 - 2).tolist()


def test_scale_is_another_reading_of_the_same_integer():
    x = QArray(every(Q(2, 2)), Q(2, 2), None)
    for power in (-5, 0, 3):
        assert x.scale(power).fmt == Q(2 + power, 2 - power)
        assert np.array_equal(x.scale(power).to_float(), x.to_float() * 2.0**power)


def test_faults_are_counted_by_name():
    faults = Counter()
    bits = QArray(np.array([1, 0, 1]), BIT, faults)
    bits.fault("edge length")
    bits.fault("edge length")
    QArray(np.array([0]), BIT, faults).fault("never")
    assert faults == {"edge length": 4} and "never" not in faults


def test_from_float_takes_the_nearest_integers_half_up():
    faults = Counter()
    numbers = QArray.from_float([-1.0, -0.375, 0.125, 0.874], Q(1, 2), faults)
    assert numbers.raw.tolist() == [-4, -1, 1, 3] and numbers.raw.dtype == np.int64 and numbers.faults is faults
    assert numbers.to_float().tolist() == [-1.0, -0.25, 0.25, 0.75]


@pytest.mark.parametrize("value", [0.875, -1.126, 3.0])
def test_from_float_refuses_what_does_not_fit(value):
    with pytest.raises(ValueError, match=rf"^ratio must be within -1 and 0\.75 size, not {value:g}$"):
        QArray.from_float([0.0, value], Q(1, 2, name="ratio", unit="size"), None)
