"""Clock sources: a PLL that makes a circuit's clock from a board's oscillator, or the oscillator's clock itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from golden.support.errors import InputError

CLOSE = 1e-6
"""Relative error up to which two frequencies are the same."""


class ClockSource(Protocol):
    """The source of a circuit's clock on a board."""

    def verilog(self, name: str, oscillator_mhz: float, clock_mhz: float) -> tuple[str, float]:
        """Return the Verilog of a module ``name`` with the ports oscillator, clock and locked, and its clock in MHz.

        Raises
        ------
        InputError
            If it can't make the clock.
        """
        ...


class Dividers(NamedTuple):
    """A PLL locks the oscillator divided by ``divide`` to its VCO divided by ``multiply``; its clock is the VCO's
    divided by ``output``."""

    divide: int
    multiply: int
    output: int

    def vco(self, oscillator_mhz: float) -> float:
        return oscillator_mhz * self.multiply / self.divide

    def mhz(self, oscillator_mhz: float) -> float:
        return self.vco(oscillator_mhz) / self.output


@dataclass(frozen=True, kw_only=True)
class Pll:
    """A family's PLL: (lowest, highest) of each frequency in MHz and of each divider, and the Verilog.

    ``template`` is formatted with the module's ``name``, the dividers ``d``, the ``oscillator`` and the clock ``mhz``
    in MHz, the oscillator's ``period`` in ns, and the ``phase`` of the output in VCO cycles.
    """

    family: str
    oscillator: tuple[float, float]
    phase_detector: tuple[float, float]
    vco: tuple[float, float]
    clock: tuple[float, float]
    divide: tuple[int, int]
    multiply: tuple[int, int]
    output: tuple[int, int]
    template: str

    def all_dividers(self, oscillator_mhz: float) -> Iterator[Dividers]:
        """All dividers within the limits."""
        if not _within(oscillator_mhz, self.oscillator):
            return
        for divide in _all(self.divide):
            if not _within(oscillator_mhz / divide, self.phase_detector):
                continue
            for multiply in _all(self.multiply):
                vco = oscillator_mhz * multiply / divide
                if not _within(vco, self.vco):
                    continue
                for output in _all(self.output):
                    if _within(vco / output, self.clock):
                        yield Dividers(divide, multiply, output)

    def dividers(self, oscillator_mhz: float, clock_mhz: float) -> Dividers:
        """Return dividers for exactly the clock: those with the fastest phase detector, which gives the least jitter,
        and of these the ones whose VCO is nearest to the middle of its range.

        Raises
        ------
        InputError
            If there are none, with the nearest clocks; or if the oscillator is too slow or too fast.
        """
        found = list(self.all_dividers(oscillator_mhz))
        if not found:
            lowest, highest = self.oscillator
            raise InputError(
                f"oscillator_mhz must be {lowest:g} to {highest:g} for a PLL of {self.family}, not {oscillator_mhz:g}"
            )
        exact = [d for d in found if abs(d.mhz(oscillator_mhz) / clock_mhz - 1) < CLOSE]
        if exact:
            middle = sum(self.vco) / 2
            return min(exact, key=lambda d: (d.divide, abs(d.vco(oscillator_mhz) - middle)))
        clocks = {d.mhz(oscillator_mhz) for d in found}
        nearest = [
            max((mhz for mhz in clocks if mhz < clock_mhz), default=None),
            min((mhz for mhz in clocks if mhz > clock_mhz), default=None),
        ]
        possible = " or ".join(f"{mhz:.9g}" for mhz in nearest if mhz is not None)
        raise InputError(
            f"clock_mhz must be a frequency that a PLL of {self.family} makes of {oscillator_mhz:g} MHz, "
            f"as {possible}, not {clock_mhz:g}"
        )

    def verilog(self, name: str, oscillator_mhz: float, clock_mhz: float) -> tuple[str, float]:
        """See `ClockSource.verilog`."""
        d = self.dividers(oscillator_mhz, clock_mhz)
        mhz = d.mhz(oscillator_mhz)
        text = self.template.format(
            name=name, d=d, oscillator=oscillator_mhz, mhz=mhz, period=1000 / oscillator_mhz, phase=d.output - 1
        )
        return text, mhz


class NoPll:
    """The oscillator's clock, for a device whose PLL the open tools don't support."""

    TEMPLATE = """module {name}(input oscillator, output clock, output locked);
  assign clock = oscillator;
  assign locked = 1'b1;
endmodule
"""

    def verilog(self, name: str, oscillator_mhz: float, clock_mhz: float) -> tuple[str, float]:
        """See `ClockSource.verilog`."""
        if clock_mhz != oscillator_mhz:
            raise InputError(f"clock_mhz must be the oscillator's {oscillator_mhz:g} without a PLL, not {clock_mhz:g}")
        return self.TEMPLATE.format(name=name), oscillator_mhz


def _within(value: float, limits: tuple[float, float]) -> bool:
    return limits[0] <= value <= limits[1]


def _all(limits: tuple[int, int]) -> range:
    return range(limits[0], limits[1] + 1)
