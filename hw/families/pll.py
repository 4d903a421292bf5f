"""PLLs: what a board's oscillator becomes. One search for all families; a module for each, with its limits and its
primitive."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from golden.support.errors import InputError

CLOSE = 1e-6
"""Relative error up to which a frequency is the one that was asked for."""


class Dividers(NamedTuple):
    """The oscillator divided by ``divide`` is compared with the oscillation divided by ``multiply``; the oscillation
    divided by ``output`` is the clock."""

    divide: int
    multiply: int
    output: int

    def oscillation(self, oscillator_mhz: float) -> float:
        return oscillator_mhz * self.multiply / self.divide

    def mhz(self, oscillator_mhz: float) -> float:
        return self.oscillation(oscillator_mhz) / self.output


class Limits(NamedTuple):
    """(least, most) of a family's PLL; frequencies in MHz."""

    family: str
    oscillator: tuple[float, float]
    phase: tuple[float, float]  # at which phases are compared
    oscillation: tuple[float, float]
    clock: tuple[float, float]
    divide: tuple[int, int]
    multiply: tuple[int, int]
    output: tuple[int, int]

    def possible(self, oscillator_mhz: float) -> Iterator[Dividers]:
        """All dividers within the limits."""
        if not _within(oscillator_mhz, self.oscillator):
            return
        for divide in _all(self.divide):
            if not _within(oscillator_mhz / divide, self.phase):
                continue
            for multiply in _all(self.multiply):
                oscillation = oscillator_mhz * multiply / divide
                if not _within(oscillation, self.oscillation):
                    continue
                for output in _all(self.output):
                    if _within(oscillation / output, self.clock):
                        yield Dividers(divide, multiply, output)

    def dividers(self, oscillator_mhz: float, clock_mhz: float) -> Dividers:
        """Exactly the clock; of those the fastest comparison of phases, which means the least jitter, and then an
        oscillation in the middle of its range.

        Raises
        ------
        InputError
            If there are none, with the clocks next to it; or if the oscillator is too slow or too fast.
        """
        found = list(self.possible(oscillator_mhz))
        if not found:
            least, most = self.oscillator
            raise InputError(
                f"oscillator_mhz must be {least:g} to {most:g} for a PLL of {self.family}, not {oscillator_mhz:g}"
            )
        exact = [d for d in found if abs(d.mhz(oscillator_mhz) / clock_mhz - 1) < CLOSE]
        if exact:
            middle = sum(self.oscillation) / 2
            return min(exact, key=lambda d: (d.divide, abs(d.oscillation(oscillator_mhz) - middle)))
        reached = {d.mhz(oscillator_mhz) for d in found}
        near = [
            max((mhz for mhz in reached if mhz < clock_mhz), default=None),
            min((mhz for mhz in reached if mhz > clock_mhz), default=None),
        ]
        would = " or ".join(f"{mhz:.9g}" for mhz in near if mhz is not None)
        raise InputError(
            f"clock_mhz must be a frequency that a PLL of {self.family} makes of {oscillator_mhz:g} MHz, "
            f"as {would}, not {clock_mhz:g}"
        )


def _within(value: float, limits: tuple[float, float]) -> bool:
    return limits[0] <= value <= limits[1]


def _all(limits: tuple[int, int]) -> range:
    return range(limits[0], limits[1] + 1)
