"""The position in a command's payload, compared with its end, and the length of its answer."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.frame import PAYLOAD_MOST
from hw.link.items import Items
from hw.link.protocol import COUNT_MOST


class PayloadPosition(wiring.Component):
    """Count bytes of a payload, and items of its answer.

    Parameters
    ----------
    items : Items

    Members
    -------
    restart : In(1)
        Go to the first byte; the answer is empty.
    step : In(1)
        Go to the next byte.
    skip : In(1), extent : In
        Go so many bytes further.
    give : In(1), given : In
        So many items more in the answer.
    length : In
        Bytes of the payload.
    position : Out
    ended, short, answer_too_long : Out(1)
        The payload ends here; it ends within an item that begins here; its answer is longer than an answer may be. All
        from the second cycle after a change on.
    """

    def __init__(self, items: Items):
        self._items = items
        longest = items.bytes * COUNT_MOST
        # the last segment of a payload may be a write whose words are missing
        self._farthest = PAYLOAD_MOST + longest
        super().__init__(
            {
                **{name: In(1) for name in ("restart", "step", "skip", "give")},
                "extent": In(range(longest + 1)),
                "given": In(range(COUNT_MOST + 1)),
                "length": In(range(PAYLOAD_MOST + 1)),
                "position": Out(range(self._farthest + 1)),
                **{name: Out(1) for name in ("ended", "short", "answer_too_long")},
            }
        )

    def elaborate(self, platform):
        m = Module()
        answer_items = Signal(range(self._items.command_most * COUNT_MOST + 1))
        m.d.sync += [
            self.ended.eq(self.position == self.length),
            self.short.eq(self.position + self._items.bytes > self.length),
            self.answer_too_long.eq(answer_items > self._items.answer_most),
        ]
        with m.If(self.restart):
            m.d.sync += [self.position.eq(0), answer_items.eq(0)]
        with m.If(self.step):
            m.d.sync += self.position.eq(self.position + 1)
        with m.If(self.skip):
            m.d.sync += self.position.eq(self.position + self.extent)
        with m.If(self.give):
            m.d.sync += answer_items.eq(answer_items + self.given)
        return m
