"""Check a command's payload as a whole, then do its segments."""

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY
from hw.link.frame import CRC, PAYLOAD_MOST
from hw.link.interfaces import ItemStream
from hw.link.items import Items
from hw.link.payload import PayloadPosition
from hw.link.port import LATENCY
from hw.link.protocol import GREETING_BYTES
from hw.link.segment import SegmentHead
from hw.link.states import check_states
from hw.link.work import Work
from hw.machine.interfaces import HostAccess

WAITING = ("idle",)
GREETING = "greeting", "segment", "gather", "head", "give"
END = "between", "segment"
"""States at the payload's end. ``between`` waits for the comparisons of the position."""
CHECK = *END, "gather", "head", "measure", "room"
"""States of a segment that is checked."""
WALK = *END, "gather", "head", "words"
"""States of a segment that is done, without its words."""
READ = "words", "access", "accessed", "give"
WRITE = "words", "gather", "access", "accessed"
SUM = "words", "access", "accessed", "sum"
"""States of a word that is read, written, or summed for a check."""
SUMMED = ("give",)
"""State of a check, after its words."""


def _cycles(path: tuple[str, ...], items: Items) -> int:
    """Return the cycles of a path, while no item has to wait until an earlier one is written."""
    lasting = {"gather": items.bytes * (READ_LATENCY + 1), "accessed": LATENCY, "sum": items.bytes}
    return sum(lasting.get(state, 1) for state in path)


def check_cycles(work: Work, items: Items) -> int:
    """Return the cycles from ``check`` to ``done``, for a payload without mistakes."""
    return work.segments * _cycles(CHECK, items) + _cycles(END, items)


def walk_cycles(work: Work, items: Items) -> int:
    """Return the cycles from ``walk`` to ``done``."""
    segments = work.segments * _cycles(WALK, items) + work.checks * _cycles(SUMMED, items)
    words = ((READ, work.read), (WRITE, work.written), (SUM, work.checked))
    return segments + sum(number * _cycles(path, items) for path, number in words) + _cycles(END, items)


class Walker(wiring.Component):
    """Do a payload's segments (`hw.link.protocol`) one after another; of a greeting, give its first item back.

    Parameters
    ----------
    state : int
        Bits of a word.

    Members
    -------
    check, walk : In(1)
        Begin to check that the payload is well-formed; to do it. Not again before ``done``.
    done : Out(1), bad : Out(1)
        The end is reached, in this cycle; the payload is malformed.
    refused : Out(1)
        At least one word was refused, since the last ``check``.
    greets : In(1)
        The payload is that of a greeting.
    length : In, index : Out, byte : In(8)
        The payload, from a `hw.link.receive.FrameReceiver`.
    items : Out(ItemStream)
        Items of the answer.
    noted : Out(1), steps : Out(32)
        A run of so many steps was begun, or ended (0).
    port : Out(HostAccess)
    """

    def __init__(self, state: int):
        self._items = items = Items.of_word(state)
        super().__init__(
            {
                **{name: In(1) for name in ("check", "walk", "greets")},
                **{name: Out(1) for name in ("done", "bad", "refused", "noted")},
                "length": In(range(PAYLOAD_MOST + 1)),
                "index": Out(range(PAYLOAD_MOST)),
                "byte": In(8),
                "items": Out(ItemStream(8 * items.bytes)),
                "steps": Out(32),
                "port": Out(HostAccess(state)),
            }
        )
        self._crc = CRC(data_width=8).create()
        self._segment = SegmentHead(items)
        self._payload = PayloadPosition(items)
        self._checks = Signal(name="checks")  # not doing
        self._writes = Signal(name="writes")  # a word to be written is gathered, not a head
        self._word = Signal(8 * items.bytes, name="word")
        self._number = Signal(range(items.bytes + 1), name="number")
        self._wait = Signal(range(READ_LATENCY + 1), name="wait")

    def elaborate(self, platform):
        m = Module()
        m.submodules.crc = crc = self._crc
        m.submodules.segment = segment = self._segment
        m.submodules.payload = payload = self._payload
        m.d.comb += [
            self.index.eq(payload.position),
            payload.length.eq(self.length),
            payload.extent.eq(segment.extent),
            payload.given.eq(Mux(segment.reads, segment.count, 1)),
            segment.head.eq(self._word),
            crc.data.eq(self._word),
            self.items.item.eq(self._word),
            self.port.write.eq(segment.writes),
            self.port.address.eq(segment.address),
            self.port.write_data.eq(self._word),
            self.steps.eq(Mux(segment.runs, self._word, 0)),
        ]
        with m.FSM() as machine:
            self._begin(m)
            self._take_segment(m)
            self._check_segment(m)
            self._do_words(m)
        check_states(machine.encoding, WAITING, GREETING, END, CHECK, WALK, READ, WRITE, SUM, SUMMED)
        return m

    def _finish(self, m: Module, bad=0):
        m.d.comb += [self.done.eq(1), self.bad.eq(bad)]
        m.next = "idle"

    def _gather(self, m: Module, *, writes: int):
        """Go on with the payload's next item."""
        m.d.sync += [self._writes.eq(writes), self._number.eq(0), self._wait.eq(READ_LATENCY)]
        m.next = "gather"

    def _begin(self, m: Module):
        with m.State("idle"):
            m.d.comb += self._payload.restart.eq(1)
            m.d.sync += self._checks.eq(self.check)
            with m.If(self.check):
                m.d.sync += self.refused.eq(0)
                m.next = "between"
                with m.If(self.greets):
                    m.next = "greeting"
            with m.Elif(self.walk):
                m.next = "between"
        with m.State("greeting"):
            self._finish(m, self.length != GREETING_BYTES)

    def _take_segment(self, m: Module):
        payload = self._payload
        with m.State("between"):
            m.next = "segment"
        with m.State("segment"):
            m.d.comb += self._crc.start.eq(1)
            with m.If(payload.ended):
                self._finish(m, payload.answer_too_long)
            with m.Elif(payload.short):
                self._finish(m, 1)
            with m.Else():
                self._gather(m, writes=0)
        with m.State("gather"):
            m.d.sync += self._wait.eq(self._wait - 1)
            with m.If(self._wait == 0):
                m.d.comb += payload.step.eq(1)
                m.d.sync += [self._word.eq(Cat(self._word[8:], self.byte)), self._wait.eq(READ_LATENCY)]
                m.d.sync += self._number.eq(self._number + 1)
                with m.If(self._number == self._items.bytes - 1):
                    m.next = "head"
                    with m.If(self._writes):
                        m.next = "access"
        with m.State("head"):
            m.d.comb += self._segment.load.eq(1)
            m.next = "words"
            with m.If(self._checks):
                m.next = "measure"
            with m.If(self.greets):
                m.next = "give"

    def _check_segment(self, m: Module):
        with m.State("measure"):
            m.next = "room"
        with m.State("room"):
            m.next = "between"
            with m.If(self._segment.reads | self._segment.checks):
                m.d.comb += self._payload.give.eq(1)
            with m.Elif(self._segment.writes):
                m.d.comb += self._payload.skip.eq(1)
            with m.Else():
                self._finish(m, 1)

    def _do_words(self, m: Module):
        segment = self._segment
        with m.State("words"):
            with m.If(segment.count != 0):
                m.next = "access"
                with m.If(segment.writes):
                    self._gather(m, writes=1)
            with m.Elif(segment.checks):
                m.d.sync += self._word.eq(self._crc.crc)
                m.next = "give"
            with m.Else():
                m.next = "between"
        with m.State("access"):
            m.d.comb += self.port.request.eq(1)
            m.next = "accessed"
        with m.State("accessed"):
            with m.If(self.port.answer):
                m.d.comb += segment.step.eq(1)
                m.d.sync += self.refused.eq(self.refused | self.port.error)
                m.next = "words"
                with m.If(~segment.writes):
                    m.d.sync += [self._word.eq(self.port.read_data), self._number.eq(0)]
                    m.next = "give"
                    with m.If(segment.checks):
                        m.next = "sum"
                m.d.comb += self.noted.eq(segment.writes & ~self.port.error & (segment.runs | segment.stops))
        with m.State("sum"):
            m.d.comb += self._crc.valid.eq(1)
            m.d.sync += [self._word.eq(self._word >> 8), self._number.eq(self._number + 1)]
            with m.If(self._number == self._items.bytes - 1):
                m.next = "words"
        with m.State("give"):
            m.d.comb += self.items.valid.eq(1)
            with m.If(self.items.ready):
                m.next = "between"
                with m.If(segment.reads & ~self.greets):
                    m.next = "words"
                with m.If(self.greets):  # the rest of its payload means nothing
                    self._finish(m)
