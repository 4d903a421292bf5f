"""A node's axes, one after the other."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.numbers.graph import AXES


class AxisSerializer(wiring.Component):
    """Holds what came with a node for as many cycles as a node has axes. Latency 1 cycle; the next node comes no sooner
    than its axes have had their turns.

    Parameters
    ----------
    width : int

    Members
    -------
    valid : In(1), i : In(width)
        A node.
    turn_valid : Out(1), axis : Out, first, last : Out(1), o : Out(width)
        One of its axes; whether it is the first or the last.
    """

    def __init__(self, *, width: int):
        super().__init__(
            {
                "valid": In(1),
                "i": In(width),
                "turn_valid": Out(1),
                "axis": Out(range(len(AXES))),
                "first": Out(1),
                "last": Out(1),
                "o": Out(width),
            }
        )

    def elaborate(self, platform):
        m = Module()
        held = Signal.like(self.o, reset_less=True)
        m.d.comb += [
            self.first.eq(self.turn_valid & (self.axis == 0)),
            self.last.eq(self.turn_valid & (self.axis == len(AXES) - 1)),
            self.o.eq(held),
        ]
        with m.If(self.valid):
            m.d.sync += [held.eq(self.i), self.axis.eq(0), self.turn_valid.eq(1)]
        with m.Else():
            m.d.sync += [self.axis.eq(self.axis + 1), self.turn_valid.eq(self.turn_valid & ~self.last)]
        return m
