"""The axes of a node, one after the other."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.numbers.graph import AXES


class AxisSerializer(wiring.Component):
    """Holds what came with a node for one cycle for each of its axes. Latency 1 cycle; the next node may come as many
    cycles after it as a node has axes.

    Parameters
    ----------
    width : int

    Members
    -------
    node_valid : In(1), node : In(width)
        A node.
    valid : Out(1), axis : Out, first, last : Out(1), held : Out(width)
        One of its axes, whether that is the first or the last, and what came with the node.
    """

    def __init__(self, *, width: int):
        super().__init__(
            {
                "node_valid": In(1),
                "node": In(width),
                "valid": Out(1),
                "axis": Out(range(len(AXES))),
                "first": Out(1),
                "last": Out(1),
                "held": Out(width),
            }
        )

    def elaborate(self, platform):
        m = Module()
        node = Signal.like(self.node, name="node_register", reset_less=True)
        m.d.comb += [
            self.first.eq(self.valid & (self.axis == 0)),
            self.last.eq(self.valid & (self.axis == len(AXES) - 1)),
            self.held.eq(node),
        ]
        with m.If(self.node_valid):
            m.d.sync += [node.eq(self.node), self.axis.eq(0), self.valid.eq(1)]
        with m.Else():
            m.d.sync += [self.axis.eq(self.axis + 1), self.valid.eq(self.valid & ~self.last)]
        return m
