"""The entry at the front of a list, and whether it may go: known one cycle ahead, from registers."""

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

LATENCY = 1
"""Cycles from an entry behind the front to it in front, and from a reason to go to going."""


class IssueRegister(wiring.Component):
    """A register between a `hw.machine.fetch.Fetch` and what its entries start.

    What makes an entry ready is compared while it still stands behind the front, or again in every cycle in which it
    stands there: that it ``goes`` is in a register, a cycle after the reason, and an entry may go in every cycle. So is
    that there is room in front, which all of the entry's registers wait for.

    Members
    -------
    flush : In(1)
    behind, behind_valid, behind_ready : In
        The next entry, if there is one; whether it is ready.
    entry, valid, goes : Out
        The entry in front, if there is one; it goes in this cycle.
    moves : Out(1)
        In the next cycle the one behind is in front, or none.
    ready : In(1)
        The entry in front is ready.
    """

    def __init__(self, *, width: int):
        self.kind = f"issue_register_{width}"
        super().__init__(
            {
                "flush": In(1),
                "behind": In(width),
                "behind_valid": In(1),
                "behind_ready": In(1),
                "entry": Out(width),
                "valid": Out(1),
                "goes": Out(1),
                "moves": Out(1, init=1),
                "ready": In(1),
            }
        )

    def elaborate(self, platform):
        m = Module()
        with m.If(self.moves):
            m.d.sync += [
                self.entry.eq(self.behind),
                self.valid.eq(self.behind_valid),
                self.goes.eq(self.behind_valid & self.behind_ready),
                self.moves.eq(~self.behind_valid | self.behind_ready),
            ]
        with m.Else():
            m.d.sync += [self.goes.eq(self.ready), self.moves.eq(self.ready)]
        with m.If(self.flush):
            m.d.sync += [self.valid.eq(0), self.goes.eq(0), self.moves.eq(1)]
        return m
