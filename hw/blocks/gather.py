"""The OR of a group of words that come one after the other."""

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.numbers.graph import AXES

GATHERED = len(AXES)
"""Words of a group, and cycles from each of them to the OR of all."""


class Gather(wiring.Component):
    """The OR of `GATHERED` words that come in consecutive cycles.

    Latency `GATHERED` cycles from each word; the result stays for as many cycles. Throughput one group in `GATHERED`
    cycles.

    Parameters
    ----------
    width : int

    Members
    -------
    i : In(width)
    first : In(1)
        ``i`` is the first word of a group.
    o : Out(width)
    """

    def __init__(self, *, width: int):
        self.kind = f"gather_{width}"
        super().__init__({"i": In(width), "first": In(1), "o": Out(width)})

    def elaborate(self, platform):
        m = Module()
        before = Signal.like(self.i, reset_less=True)
        held = Signal.like(self.i, reset_less=True)
        whole = Signal.like(self.i)  # the OR since the first word
        ago = Signal(GATHERED - 1, reset_less=True)
        m.d.comb += [whole.eq(Mux(self.first, 0, before) | self.i), self.o.eq(held)]
        m.d.sync += [before.eq(whole), ago.eq(Cat(self.first, ago))]
        with m.If(ago[-1]):
            m.d.sync += held.eq(whole)
        return m
