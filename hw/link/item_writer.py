"""Write items into an answer."""

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.items import Items
from hw.link.send import ANSWER_MOST


class ItemWriter(wiring.Component):
    """Writes items one after another, lowest byte first: one in as many cycles as it has bytes, and one more.

    Parameters
    ----------
    items : Items

    Members
    -------
    begin : In(1), at : In
        The next item goes there.
    valid : In(1), item : In, ready : Out(1)
        An item is taken in a cycle in which both are 1. While ``ready``, all that were taken have been written.
    write : Out(1), place : Out, data : Out(8)
        A byte of the answer. While ``ready``, ``place`` is the one after the last item.
    """

    def __init__(self, items: Items):
        self._bytes = items.bytes
        super().__init__(
            {
                "begin": In(1),
                "at": In(range(ANSWER_MOST + 1)),
                "valid": In(1),
                "item": In(8 * items.bytes),
                "ready": Out(1),
                "write": Out(1),
                "place": Out(range(ANSWER_MOST + 1)),
                "data": Out(8),
            }
        )

    def elaborate(self, platform):
        m = Module()
        rest = Signal.like(self.item)
        left = Signal(range(self._bytes + 1))
        m.d.comb += [self.ready.eq(left == 0), self.write.eq(left != 0), self.data.eq(rest[:8])]
        with m.If(self.ready & self.valid):
            m.d.sync += [rest.eq(self.item), left.eq(self._bytes)]
        with m.If(~self.ready):
            m.d.sync += [rest.eq(Cat(rest[8:])), left.eq(left - 1), self.place.eq(self.place + 1)]
        with m.If(self.begin):
            m.d.sync += self.place.eq(self.at)
        return m
