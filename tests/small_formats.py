"""All formats of a few bits, for exhaustive tests of the arithmetic."""

import apytypes
import numpy as np

from golden.numbers.qarray import QArray
from golden.numbers.qformat import Q


def small_formats(widths, int_bits) -> list[Q]:
    return [Q(i, width - i, signed) for width in widths for i in int_bits for signed in (True, False)]


def every(q: Q) -> np.ndarray:
    """Return every integer of a format."""
    return np.arange(q.raw_min, q.raw_max + 1)


def every_pair(a: Q, b: Q, faults=None) -> tuple[QArray, QArray]:
    """Return every pair of numbers of two formats."""
    x, y = (grid.ravel() for grid in np.meshgrid(every(a), every(b)))
    return QArray(x, a, faults), QArray(y, b, faults)


def outside(x: QArray) -> apytypes.APyFixedArray:
    """Return the same numbers in apytypes, which knows signed formats only: an unsigned one gets a sign bit."""
    return apytypes.APyFixedArray(x.raw.tolist(), x.fmt.int_bits + (not x.fmt.signed), x.fmt.frac_bits)


def same(x: QArray, theirs: apytypes.APyFixedArray) -> bool:
    """Return whether the values are the same; at these widths float64 holds them."""
    return np.array_equal(x.to_float(), theirs.to_numpy())
