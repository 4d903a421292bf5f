"""Block-normalised vectors: how near the mantissas are to the vector, and the arithmetic around them."""

from collections import Counter
from fractions import Fraction

import numpy as np
import pytest
from integer_objects import random_raw

from golden.numbers.block import clamp, difference, dot, magnitude, normalise, with_sign
from golden.numbers.qarray import QArray
from golden.numbers.qformat import BIT, Q, unsigned

VECTOR = Q(1, 36)
SIZE = Q(0, 36, signed=False)
OPERAND = 18


def number(raw, q, faults=None):
    return QArray(np.asarray(raw, np.int64), q, faults)


def vectors(rng, q, count=20_000):
    """Components of every magnitude, corner values among them."""
    return [number(random_raw(rng, q, count) >> rng.integers(0, q.width, count), q, Counter()) for _ in range(3)]


@pytest.mark.parametrize("q", [VECTOR, SIZE], ids=["signed", "unsigned"])
def test_mantissas_are_the_vector_to_half_of_their_last_place(q, rng):
    vector = vectors(rng, q)
    mantissas, shift = normalise(vector, OPERAND)
    drop = q.width - OPERAND
    last = 0
    for x, m in zip(vector, mantissas, strict=True):
        assert m.fmt == Q(q.int_bits, OPERAND - q.int_bits, q.signed)
        # in last places of the mantissa, times 2**drop, in exact integers
        error = (m.raw << drop) - (x.raw << shift.raw)
        half = 1 << drop - 1
        saturated = m.raw == m.fmt.raw_max
        assert (np.abs(error) <= half)[~saturated].all()
        assert (error[saturated] <= half).all() and (error[saturated] > -2 * half).all()
        last = last + saturated
    assert not vector[0].faults  # mantissas have no name: to lose less than a last place is no fault
    assert last.any()


@pytest.mark.parametrize("q", [VECTOR, SIZE], ids=["signed", "unsigned"])
def test_the_largest_component_uses_all_bits_unless_the_vector_is_exact(q, rng):
    vector = vectors(rng, q)
    mantissas, shift = normalise(vector, OPERAND)
    largest = np.max([np.abs(m.raw) for m in mantissas], axis=0)
    exact = shift.raw == q.width - OPERAND
    assert (largest[~exact] >= 1 << OPERAND - 1 - q.signed).all()
    for x, m in zip(vector, mantissas, strict=True):
        assert np.array_equal(m.raw[exact], x.raw[exact])
    assert exact.any() and not exact.all()


def test_a_vector_must_be_wider_than_its_mantissas():
    with pytest.raises(ValueError, match=r"^a vector must be wider than its 18-bit mantissas, not 18 bits$"):
        normalise([number([1], Q(1, 17))], 18)


def test_a_magnitude_is_its_mantissa_times_a_power_of_two(rng):
    q, operand = Q(2, 35), 18
    raw = np.concatenate([random_raw(rng, q, 5000) >> rng.integers(0, 36, 5000), [0, 1, -1, q.raw_min, q.raw_max]])
    raw = np.concatenate([raw, 1 << np.arange(36), -(1 << np.arange(36))])
    size, mantissa, shift = magnitude(number(raw, q), operand)
    assert np.array_equal(size.raw, abs(raw))
    value = np.ldexp(mantissa.to_float(), 1 - shift.raw)
    error = np.ldexp(abs(raw).astype(float), -35) - value
    assert (error >= 0).all()
    assert (error <= np.ldexp(1.0, 1 - shift.raw - operand)).all()  # a step; exactly one where 1 saturates
    assert ((mantissa.raw >= 1 << operand - 1) | (shift.raw == shift.raw.max())).all()


def test_difference_and_total_are_exact(rng):
    q = Q(1, 17)
    a, b = ([number(random_raw(rng, q, 1000), q) for _ in range(3)] for _ in range(2))
    for x, y, z in zip(a, b, difference(a, b), strict=True):
        assert np.array_equal(z.raw, x.raw - y.raw)
    for many in range(1, 4):
        assert np.array_equal(a[0].total(a[:many]).raw, sum(x.raw for x in a[:many]))


@pytest.mark.parametrize("frac_bits", [34, 22])
def test_a_scalar_product_is_that_of_products_that_are_cut(rng, frac_bits):
    q = Q(1, 17)
    a, b = ([number(random_raw(rng, q, 1000), q) for _ in range(3)] for _ in range(2))
    exact = sum(x.to_float() * y.to_float() for x, y in zip(a, b, strict=True))  # 34 bits
    error = exact - dot(a, b, frac_bits).to_float()
    assert (0 <= error).all() and (error < 3 * 2.0**-frac_bits).all()
    assert error.any() == (frac_bits < 34)


def test_clamp_keeps_a_number_between_its_bounds():
    x, low, high = (number(raw, Q(4, 0)) for raw in ([-8, -3, -2, 0, 2, 3, 7], [-2] * 7, [2] * 7))
    assert clamp(x, low, high).raw.tolist() == [-2, -2, -2, 0, 2, 2, 2]
    assert clamp(x, low, low).raw.tolist() == [-2] * 7


def test_with_sign_puts_a_sign_before_a_magnitude():
    bit, magnitude = number([0, 1, 1], BIT), number([255, 255, 0], unsigned(0, 8))
    assert with_sign(bit, magnitude).to_float().tolist() == [255 / 256, -255 / 256, 0.0]


def test_the_shift_is_shared_and_counts_the_largest_component():
    x, y = number([5], Q(1, 9)), number([-64], Q(1, 9))
    (a, b), shift = normalise([x, y], 6)
    assert (a.raw[0], b.raw[0], shift.raw[0]) == (3, -32, 3)  # 5/512 * 8 = 2.5/32, half up
    assert Fraction(int(b.raw[0]), 32 * 2 ** int(shift.raw[0])) == Fraction(-64, 512)
