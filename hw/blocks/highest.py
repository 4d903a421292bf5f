"""The highest of several numbers."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out


def latency(count: int) -> int:
    """Return the latency in cycles: one to replace invalid numbers by 0, one for each level of comparisons."""
    return 1 + (count - 1).bit_length()


class Highest(wiring.Component):
    """The highest of the valid numbers, or 0.

    Latency `latency` (count) cycles, throughput one result a cycle.

    Parameters
    ----------
    count, width : int

    Members
    -------
    valid : In(count), numbers : In(count * width)
    highest : Out(width)
    """

    def __init__(self, *, count: int, width: int):
        self._width = width
        super().__init__({"valid": In(count), "numbers": In(count * width), "highest": Out(width)})

    def elaborate(self, platform):
        m = Module()

        def registered(values, level):
            registers = [Signal(self._width, name=f"highest_{level}_{n}", reset_less=True) for n in range(len(values))]
            m.d.sync += [register.eq(value) for register, value in zip(registers, values, strict=True)]
            return registers

        numbers = [self.numbers.word_select(n, self._width) for n in range(len(self.valid))]
        best = registered([Mux(valid, number, 0) for valid, number in zip(self.valid, numbers, strict=True)], 0)
        for level in range(1, latency(len(self.valid))):
            pairs = [best[first : first + 2] for first in range(0, len(best), 2)]
            best = registered([Mux(p[0] > p[-1], p[0], p[-1]) for p in pairs], level)
        m.d.comb += self.highest.eq(best[0])
        return m
