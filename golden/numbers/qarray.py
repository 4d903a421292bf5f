"""Bit-exact fixed-point arrays on NumPy integers: the reference for every other number type.

`golden.datapath.edge` and `golden.datapath.node` use only the operations of `golden.numbers.number.Number`. So the same
lines are this integer model and, on `golden.numbers.graph.Operation`, a compiled program and a pipeline.
"""

from collections import Counter

import numpy as np

from golden.numbers.qformat import BIT, Q, count, round_half_up, smallest, total


class QArray:
    """Integers ``raw`` (int64, any shape) that stand for ``raw * 2**-fmt.frac_bits``.

    All operations are exact, only `to` rounds. A saturation there is counted in ``faults`` under the name of the
    format; a saturation to a format without a name is no fault.
    """

    __slots__ = ("faults", "fmt", "raw")

    def __init__(self, raw, fmt: Q, faults: Counter):
        self.raw, self.fmt, self.faults = raw, fmt, faults

    @classmethod
    def from_float(cls, x, fmt: Q, faults: Counter) -> "QArray":
        """Return the nearest numbers, as `golden.numbers.qformat.Q.quantise` gives them."""
        return cls(np.asarray(fmt.quantise(x), np.int64), fmt, faults)

    def to_float(self):
        return self.fmt.to_float(self.raw)

    def _new(self, raw, fmt):
        return QArray(raw, fmt, self.faults)

    def _number(self, other, beside=None) -> "QArray":
        """Return ``other``; an integer in the smallest format that holds it, 0 in the format of ``beside``."""
        if isinstance(other, QArray):
            return other
        return self._new(np.int64(other), beside.fmt if other == 0 and isinstance(beside, QArray) else smallest(other))

    def _aligned(self, other):
        left = self.fmt.frac_bits - other.fmt.frac_bits
        if left == 0:
            return self.raw, other.raw
        return (self.raw, other.raw << left) if left > 0 else (self.raw << -left, other.raw)

    def __add__(self, other):
        other = self._number(other)
        a, b = self._aligned(other)
        return self._new(a + b, self.fmt + other.fmt)

    __radd__ = __add__

    def __sub__(self, other):
        other = self._number(other)
        a, b = self._aligned(other)
        return self._new(a - b, self.fmt - other.fmt)

    def __rsub__(self, other):
        return self._number(other) - self

    def __mul__(self, other):
        return self._new(self.raw * other.raw, self.fmt * other.fmt)

    def __abs__(self):
        return self._new(np.abs(self.raw), abs(self.fmt))

    def __lt__(self, other):
        a, b = self._aligned(self._number(other))
        return self._new((a < b).astype(np.int64), BIT)

    @staticmethod
    def total(terms) -> "QArray":
        """Return the sum of all ``terms``."""
        frac = max(x.fmt.frac_bits for x in terms)
        return terms[0]._new(sum(x.raw << frac - x.fmt.frac_bits for x in terms), total(x.fmt for x in terms))

    def select(self, yes, no):
        """Return ``yes`` where this bit is 1, ``no`` where it is 0, in the format that holds both."""
        yes, no = self._number(yes, no), self._number(no, yes)
        a, b = yes._aligned(no)
        return self._new(np.where(self.raw, a, b), yes.fmt.union(no.fmt))

    def scale(self, power: int):
        """Return this number times ``2**power``: the same integer in another format."""
        return self._new(self.raw, self.fmt.scale(power))

    def field(self, low: int, fmt: Q):
        """Return bits ``low`` and up of the integer, read as ``fmt``."""
        return self._new(fmt.from_bits(self.raw >> low), fmt)

    def fault(self, name: str):
        """Count a fault called ``name`` wherever this bit is 1."""
        if count := int(np.count_nonzero(self.raw)):
            self.faults[name] += count

    @staticmethod
    def lead(vector, most: int) -> "QArray":
        """Return how far left all numbers of ``vector`` can be shifted without loss, at most ``most``."""
        fmt, magnitude = vector[0].fmt, 0
        for x in vector:
            magnitude = magnitude | (x.raw ^ x.raw >> 63)
        leading = magnitude & ~(magnitude >> 1)  # the bit below its highest is 0, so float64 can't round it up
        length = np.frexp(leading.astype(float))[1].astype(np.int64)
        return vector[0]._new(np.minimum(fmt.width - fmt.signed - length, most), count(most))

    def to(self, fmt: Q, *, left=None, right=None, cut=False):
        """Return this number (times ``2**left``, or ``2**-right``) in the format ``fmt``: rounded half up, saturated.

        ``left`` is a shift that loses no leading bits, as `lead` counts it. A shift to the right may ``cut`` instead of
        rounding: it then rounds down, which needs no carry.

        Saturation is a fault if the exact value is an LSB or more above the largest number, or rounds to below the
        smallest. A negative ``right`` saturates, with a fault, unless the value is 0: it can't shift to the left.
        """
        raw, drop = self.raw, self.fmt.frac_bits - fmt.frac_bits
        if left is not None:
            raw = raw << left.raw
        if drop < 0:
            raw, drop = raw << -drop, 0
        beyond = None
        if right is not None:
            if (right.raw < 0).any():
                beyond = (right.raw < 0) & (raw != 0)
            drop = np.minimum(np.maximum(drop + right.raw, 0), 62)
        if right is None and drop == 0:
            rounded = floor = raw
        else:
            floor = raw >> drop
            rounded = floor if cut else round_half_up(raw, drop)
        result = np.minimum(np.maximum(rounded, fmt.raw_min), fmt.raw_max)
        if beyond is not None:
            result = np.where(beyond, np.where(raw < 0, fmt.raw_min, fmt.raw_max), result)
        if fmt.name and (beyond is not None or (result != rounded).any()):
            over = (floor > fmt.raw_max) | (rounded < fmt.raw_min)
            self._new(over if beyond is None else over | beyond, BIT).fault(fmt.name)
        return self._new(result, fmt)
