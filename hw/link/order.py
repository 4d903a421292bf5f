"""The order of commands: each is done once, after the one before it."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.protocol import WINDOW
from hw.link.send import ANSWERS


class CommandOrder(wiring.Component):
    """Compare a command's sequence number with the one that is expected.

    Members
    -------
    seq : In(8), greets : In(1)
        The command; ``greets`` if it is a greeting.
    waits : In(8)
        A bit for each kept answer that is still to be sent (`hw.link.send.FrameSender`).
    begin : In(1)
        A session begins with the command.
    advance : In(1)
        The command is done: during a session, the next one is expected.
    session : Out(1)
    due, done, free : Out(1)
        The command is to be done now; it was done before, and its answer is kept; no answer waits where its answer
        goes. All in the cycle after ``seq`` and ``greets``.
    """

    def __init__(self):
        strobes = {name: In(1) for name in ("greets", "begin", "advance")}
        answers = {name: Out(1) for name in ("session", "due", "done", "free")}
        super().__init__({"seq": In(8), "waits": In(ANSWERS), **strobes, **answers})

    def elaborate(self, platform):
        m = Module()
        expected = Signal(8)
        ahead = Signal(8)
        m.d.comb += ahead.eq(self.seq - expected)
        m.d.sync += [
            self.due.eq(self.greets | ~self.session | (ahead == 0)),
            self.done.eq(ahead >= 256 - WINDOW),
            self.free.eq(~self.waits.bit_select(self.seq[: (ANSWERS - 1).bit_length()], 1)),
        ]
        with m.If(self.begin):
            m.d.sync += [self.session.eq(1), expected.eq(self.seq)]
        with m.Elif(self.advance):
            m.d.sync += expected.eq(expected + self.session)
        return m
