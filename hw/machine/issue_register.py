"""The register from which a list's entries are issued."""

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.machine.interfaces import Advance

LATENCY = 1
"""Cycles from a fetched entry to the entry in the register, and from a reason to issue to the issue."""


class IssueRegister(wiring.Component):
    """A register between a list's `hw.machine.fetch` and what its entries start.

    Whether an entry is ready is known one cycle ahead, so that ``issue`` and ``advances`` come from registers: the
    comparisons are slow, and ``advances`` drives every bit of the entry. An entry can be issued in every cycle.

    Members
    -------
    flush : In(1)
        Empty the register.
    advance : In(Advance), next : In
        The fetched entry.
    entry, valid, issue : Out
        The entry in the register; whether there is one; whether it is issued in this cycle.
    advances : Out(1)
        In the next cycle the register holds the entry that is now fetched, or none.

    Raises
    ------
    ValueError
        If `LATENCY` isn't 1: there is one register.
    """

    def __init__(self, *, width: int):
        if LATENCY != 1:
            raise ValueError(f"the latency of an issue register must be 1, not {LATENCY}")
        self.kind = f"issue_register_{width}"
        super().__init__(
            {
                "flush": In(1),
                "advance": In(Advance()),
                "next": In(width),
                "entry": Out(width),
                "valid": Out(1),
                "issue": Out(1),
                "advances": Out(1, init=1),
            }
        )

    def elaborate(self, platform):
        m, advance = Module(), self.advance
        with m.If(self.advances):
            m.d.sync += [
                self.entry.eq(self.next),
                self.valid.eq(advance.next_valid),
                self.issue.eq(advance.next_valid & advance.next_ready),
                self.advances.eq(~advance.next_valid | advance.next_ready),
            ]
        with m.Else():
            m.d.sync += [self.issue.eq(advance.ready), self.advances.eq(advance.ready)]
        with m.If(self.flush):
            m.d.sync += [self.valid.eq(0), self.issue.eq(0), self.advances.eq(1)]
        return m
