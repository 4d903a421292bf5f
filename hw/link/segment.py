"""The head of a payload's segment, and the address of its next word."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.items import Items
from hw.link.protocol import COUNT_MOST, HEAD, Kind
from hw.map.control import Control
from hw.map.memory_map import ADDRESS, Region, join


class SegmentHead(wiring.Component):
    """Hold a segment's head (`hw.link.protocol.HEAD`) while its words are done.

    Parameters
    ----------
    items : Items

    Members
    -------
    load : In(1), head : In
        A new segment.
    step : In(1)
        A word is done: count down, and go to the next address. Its index, or with ``across`` its word, wraps within its
        field: a segment that is too long comes back to its own beginning.
    address, across, count : Out
        The head of the words that are left.
    reads, writes, checks : Out(1)
        The segment's kind; all 0 if there is no such kind.
    extent : Out
        Bytes of the words that are left.
    runs, stops : Out(1)
        ``address`` is the control register RUN, or STOP. Like ``extent``, from the second cycle after ``load`` or
        ``step`` on.
    """

    def __init__(self, items: Items):
        self._bytes = items.bytes
        super().__init__(
            {
                "load": In(1),
                "head": In(HEAD.width),
                "step": In(1),
                **{name: Out(HEAD[name].width) for name in ("address", "across", "count")},
                **{name: Out(1) for name in ("reads", "writes", "checks")},
                "extent": Out(range(items.bytes * COUNT_MOST + 1)),
                "runs": Out(1),
                "stops": Out(1),
            }
        )

    def elaborate(self, platform):
        m = Module()
        shifts = [n for n in range(self._bytes.bit_length()) if self._bytes >> n & 1]  # a product without a multiplier
        kind = Signal(HEAD["kind"].width)
        m.d.comb += [
            self.reads.eq(kind == Kind.READ),
            self.writes.eq(kind == Kind.WRITE),
            self.checks.eq(kind == Kind.CHECK),
        ]
        m.d.sync += [
            self.extent.eq(sum(self.count << n for n in shifts)),
            self.runs.eq(self.address == _control(Control.RUN)),
            self.stops.eq(self.address == _control(Control.STOP)),
        ]
        index, word = ADDRESS.field("index", self.address), ADDRESS.field("word", self.address)
        with m.If(self.load):
            head = HEAD.unpack(self.head)
            m.d.sync += [
                self.address.eq(head["address"]),
                self.across.eq(head["across"]),
                kind.eq(head["kind"]),
                self.count.eq(head["count"]),
            ]
        with m.Elif(self.step):
            m.d.sync += self.count.eq(self.count - 1)
            with m.If(self.across):
                m.d.sync += word.eq(word + 1)
            with m.Else():
                m.d.sync += index.eq(index + 1)
        return m


def _control(register: Control) -> int:
    return join(Region.CONTROL, 0, register, 0)
