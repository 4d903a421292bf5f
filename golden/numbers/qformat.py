"""Fixed-point formats: the algebra of widths, and the one conversion from and to float64."""

from dataclasses import dataclass
from functools import cache, cached_property, reduce

import numpy as np


@dataclass(frozen=True)
class Q:
    """Two's-complement (or unsigned) fixed point: an integer ``raw`` stands for ``raw * 2**-frac_bits``.

    ``int_bits`` counts the sign bit of a signed format, so ``Q(1, 17)`` is 18 bits wide and holds [-1, 1) in
    steps of 2**-17, and ``Q(0, 18, signed=False)`` is 18 bits wide and holds [0, 1) in steps of 2**-18. Either
    count may be negative, as long as their sum, the width, is not.

    The operators return the format that holds every exact result: nothing rounds, nothing overflows.

    Raises
    ------
    ValueError
        If the format has no bits.
    """

    int_bits: int
    frac_bits: int
    signed: bool = True
    name: str = ""
    unit: str = ""

    def __post_init__(self):
        if self.width < 1:
            raise ValueError(f"a format must have at least 1 bit, not {self.width} ({self})")

    @cached_property
    def _hash(self):
        return hash((self.int_bits, self.frac_bits, self.signed, self.name))

    def __hash__(self):
        return self._hash

    @cached_property
    def width(self) -> int:
        return self.int_bits + self.frac_bits

    @cached_property
    def lsb(self) -> float:
        return 2.0**-self.frac_bits

    @cached_property
    def raw_min(self) -> int:
        return -(1 << self.width - 1) if self.signed else 0

    @cached_property
    def raw_max(self) -> int:
        return (1 << self.width - self.signed) - 1

    def from_bits(self, bits):
        """Return the integer that the lowest `width` bits of ``bits`` stand for, whatever the higher bits are."""
        sign = self.signed << self.width - 1
        return (bits & (1 << self.width) - 1 ^ sign) - sign

    def quantise(self, x, *, saturate: bool = False):
        """Return the nearest integers to ``x``, in units of `lsb`, rounded half up: an int, or an int64 array.

        Raises
        ------
        ValueError
            If one is out of range, unless it may ``saturate``; if one is not a number.
        """
        exact = np.ldexp(np.asarray(x, float), self.frac_bits)
        floor = np.floor(exact)
        with np.errstate(invalid="ignore"):  # of infinities
            raw = floor + (exact - floor >= 0.5)
        if saturate:
            raw = np.clip(raw, self.raw_min, self.raw_max)
        if not np.all((self.raw_min <= raw) & (raw <= self.raw_max)):
            low, high, worst = self.raw_min * self.lsb, self.raw_max * self.lsb, np.ravel(x)[np.argmax(np.abs(x))]
            unit = f" {self.unit}" if self.unit else ""
            raise ValueError(f"{self.name or self} must be within {low:g} and {high:g}{unit}, not {worst:g}")
        return raw.astype(np.int64) if raw.ndim else int(raw)

    def to_float(self, raw):
        """Return the float64 values that these integers stand for."""
        return np.ldexp(np.asarray(raw, float), -self.frac_bits)

    @cached_property
    def nameless(self) -> "Q":
        """The same format without a name: a number that saturates to it is no fault."""
        return Q(self.int_bits, self.frac_bits, self.signed)

    def __str__(self):
        return f"{'' if self.signed else 'U'}Q{self.int_bits}.{self.frac_bits}"

    def _magnitude_bits(self) -> int:
        """Integer bits not counting the sign."""
        return self.int_bits - self.signed

    @cache  # noqa: B019 (a handful of formats exist)
    def union(self, other: "Q") -> "Q":
        """Return the smallest format that holds the values of both."""
        signed = self.signed or other.signed
        magnitude_bits = max(self._magnitude_bits(), other._magnitude_bits())
        return Q(magnitude_bits + signed, max(self.frac_bits, other.frac_bits), signed)

    @cache  # noqa: B019 (a handful of formats exist)
    def __add__(self, other: "Q") -> "Q":
        both = self.union(other)
        return Q(both.int_bits + 1, both.frac_bits, both.signed)

    @cache  # noqa: B019 (a handful of formats exist)
    def __sub__(self, other: "Q") -> "Q":
        both = self.union(other)
        return Q(both._magnitude_bits() + (2 if both.signed else 1), both.frac_bits)

    @cache  # noqa: B019 (a handful of formats exist)
    def __mul__(self, other: "Q") -> "Q":
        return Q(self.int_bits + other.int_bits, self.frac_bits + other.frac_bits, self.signed or other.signed)

    @cache  # noqa: B019 (a handful of formats exist)
    def __abs__(self) -> "Q":
        return Q(self.int_bits, self.frac_bits, signed=False)

    @cache  # noqa: B019 (a handful of formats exist)
    def scale(self, power: int) -> "Q":
        """Return the format in which the same integer stands for a value ``2**power`` times as large."""
        return Q(self.int_bits + power, self.frac_bits - power, self.signed)


def unsigned(int_bits: int, frac_bits: int, **kwargs) -> Q:
    return Q(int_bits, frac_bits, signed=False, **kwargs)


BIT = unsigned(1, 0)


def total(formats) -> Q:
    """Return the format of an exact sum of numbers in these formats."""
    formats = list(formats)
    both = reduce(Q.union, formats)
    return Q(both.int_bits + (len(formats) - 1).bit_length(), both.frac_bits, both.signed)


def round_half_up(raw, drop):
    """Return ``raw / 2**drop`` rounded half up: an int, or an array of integers of at most 63 bits.

    ``drop`` is at least 0.
    """
    return ((raw << 1) >> drop) + 1 >> 1


def smallest(raw: int) -> Q:
    """Return the smallest integer format that holds ``raw``."""
    return Q((~raw).bit_length() + 1, 0) if raw < 0 else unsigned(max(raw.bit_length(), 1), 0)


def count(most: int) -> Q:
    """Return the format of a count from 0 to ``most``."""
    return unsigned(most.bit_length(), 0)
