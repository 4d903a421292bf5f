"""The contents of the datapath's tables: 1 / sqrt(q), and sigma and rho over |g| for a force-dependent damper.

Each segment is a straight line through the middle of the band between chord and curve, so that its error is half of
the chord's.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import floor
from types import SimpleNamespace

import numpy as np

from golden.datapath import records
from golden.datapath.formats import Formats


def _lines(curve: Callable, start: np.ndarray, end: np.ndarray):
    """Return the value at the start of each segment and the change over it, in float64."""
    first, last, middle = curve(start), curve(end), curve((start + end) / 2)
    return first + (middle - (first + last) / 2) / 2, last - first


def inverse_table(fmt: Formats) -> dict[str, np.ndarray]:
    """Return the table of 1 / sqrt(q) on [1, 4), indexed by the leading bits of q. A normalised q is never below 1."""
    entries = 1 << fmt.inverse_index.width
    q = np.maximum(np.arange(entries) * 4.0 / entries, 1.0)
    value, change = _lines(lambda q: q**-0.5, q, q + 4.0 / entries)
    change[: entries // 4] = 0
    # The result is cut, so the lines are half an LSB higher. They must stay below 1, so the first one starts lower
    value, end = value + fmt.inverse.lsb / 2, value + fmt.inverse.lsb / 2 + change
    value = np.minimum(value, 1 - fmt.inverse_value.lsb)
    change = np.where(change, end - value, 0)
    return {
        "value": fmt.inverse_value.quantise(value, saturate=True),
        "slope": fmt.inverse_slope.quantise(-change, saturate=True),
    }


@dataclass(frozen=True)
class DamperTable:
    """The segments of one material: where they start on the octave axis, the power of two of them per octave, and
    their words."""

    first_octave: int  # raw
    fineness: int
    words: dict[str, np.ndarray]


def damper_table(fmt: Formats, g1: float, g2: float, rho: Callable, sigma: Callable) -> DamperTable:
    """Return the middle branch of (7) for g1 <= |g| <= g2 < 2, in units of the trial force's full scale.

    ``rho`` and ``sigma`` are smooth functions of |g| in those units, continued past both ends.

    Raises
    ------
    ValueError
        If the branch starts below the octaves that the datapath normalises, or is too steep for the table.
    """
    lowest = 2.0**-fmt.trial_octaves
    if g1 < lowest:
        raise ValueError(f"g1 must be at least {lowest:g} of the trial force's full scale, not {g1:g}")
    first, last = octave(g1), octave(g2)
    segments = 1 << fmt.damper_index.width
    finest = fmt.octave.frac_bits
    per_octave = next(2**p for p in range(finest, -1, -1) if floor(last * 2**p) - floor(first * 2**p) < segments)
    start = floor(first * per_octave) / per_octave
    used = floor(last * per_octave) - floor(first * per_octave) + 1
    middle = (
        fmt.octave_fraction.lsb / 2
    )  # |g| is cut (`golden.numbers.block.magnitude`): this is the middle of all that give the same bits
    g = octave_inverse(start + np.arange(segments + 1) / per_octave + middle)
    words = {}
    for name, curve, sign in (("rho", rho, -1), ("sigma", sigma, 1)):
        value, change = _lines(curve, g[:-1], g[1:])
        largest = np.maximum(value, value + change) * (1 + 4 * fmt.damper_value.lsb)  # both may round up
        shift = np.clip(-np.frexp(largest)[1], 0, fmt.damper_shift.raw_max)
        steepest = np.ldexp(np.abs(change), shift)[:used].max()
        if steepest >= fmt.damper_slope.raw_max * fmt.damper_slope.lsb:
            raise ValueError(f"{name} must change by less than 1/8 of itself in a segment, not {steepest:.2g}")
        words[f"{name}_value"] = fmt.damper_value.quantise(np.ldexp(value, shift) + fmt.mantissa.lsb / 2, saturate=True)
        words[f"{name}_slope"] = fmt.damper_slope.quantise(np.ldexp(sign * change, shift), saturate=True)
        words[f"{name}_shift"] = shift.astype(np.int64)
    return DamperTable(int(start * 2**finest), per_octave.bit_length() - 1, words)


def octave(x):
    """Return the logarithm as the circuit computes it: exponent plus fraction of the mantissa."""
    mantissa, exponent = np.frexp(x)
    return exponent - 1 + (2 * mantissa - 1)


def octave_inverse(position):
    """Return the number whose `octave` is ``position``."""
    exponent = np.floor(position)
    return np.ldexp(1 + position - exponent, exponent.astype(int))


class Tables:
    """The lookups of `golden.datapath.edge` on `golden.numbers.qarray` numbers."""

    def __init__(self, fmt: Formats, inverse: dict[str, np.ndarray], damper: dict[str, np.ndarray]):
        """``damper``: arrays of shape (tables, segments)."""
        self._inverse, self._damper = inverse, damper
        self._inverse_word, self._damper_word = records.inverse_word(fmt), records.damper_word(fmt)

    @staticmethod
    def _read(contents, word, like, *index):
        return SimpleNamespace(**{name: type(like)(contents[name][index], q, like.faults) for name, q in word.items()})

    def inverse(self, index):
        return self._read(self._inverse, self._inverse_word, index, index.raw)

    def damper(self, table, index):
        return self._read(self._damper, self._damper_word, index, table.raw, index.raw)
