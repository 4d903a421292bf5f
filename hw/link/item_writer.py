"""Write items into an answer."""

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.interfaces import ItemStream
from hw.link.items import Items
from hw.link.send import ANSWER_MOST


class ItemWriter(wiring.Component):
    """Write items one after another, lowest byte first. An item takes a cycle a byte, and one more to be taken.

    Parameters
    ----------
    items : Items

    Members
    -------
    begin : In(1), at : In
        The next item goes to the byte index ``at``.
    stream : In(ItemStream)
        Items. While ``ready``, all that were taken have been written.
    write : Out(1), index : Out, data : Out(8)
        A byte of the answer. While ``stream.ready``, ``index`` is the one after the last item.
    """

    def __init__(self, items: Items):
        self._bytes = items.bytes
        super().__init__(
            {
                "begin": In(1),
                "at": In(range(ANSWER_MOST + 1)),
                "stream": In(ItemStream(8 * items.bytes)),
                "write": Out(1),
                "index": Out(range(ANSWER_MOST + 1)),
                "data": Out(8),
            }
        )

    def elaborate(self, platform):
        m = Module()
        rest = Signal.like(self.stream.item)
        left = Signal(range(self._bytes + 1))
        m.d.comb += [self.stream.ready.eq(left == 0), self.write.eq(left != 0), self.data.eq(rest[:8])]
        with m.If(self.stream.ready & self.stream.valid):
            m.d.sync += [rest.eq(self.stream.item), left.eq(self._bytes)]
        with m.If(~self.stream.ready):
            m.d.sync += [rest.eq(Cat(rest[8:])), left.eq(left - 1), self.index.eq(self.index + 1)]
        with m.If(self.begin):
            m.d.sync += self.index.eq(self.at)
        return m
