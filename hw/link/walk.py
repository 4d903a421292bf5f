"""A command's payload, looked through as a whole before anything of it is done."""

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY
from hw.link.frame import CRC, PAYLOAD_MOST
from hw.link.items import Items
from hw.link.protocol import GREETING_BYTES, HEAD, Kind
from hw.machine.interfaces import HostAccess
from hw.map.control import Control
from hw.map.memory_map import ADDRESS, Region, join


class Walker(wiring.Component):
    """Does a payload's segments (`hw.link.protocol`) one after the other; or, of a greeting, gives its item back.

    Parameters
    ----------
    state : int
        Bits of a word.

    Members
    -------
    look, walk : In(1)
        Begin: to look whether the payload is what it should be; to do it. Not again before ``done``.
    done : Out(1), bad : Out(1)
        Through, in this cycle; it is not what it should be.
    refused : Out(1)
        At least one word was refused, since the last ``look``.
    greets : In(1), length : In, place : Out, byte : In(8)
        The payload, as of a `hw.link.receive.FrameReceiver`.
    item_valid : Out(1), item : Out, item_ready : In(1)
        To a `hw.link.item_writer.ItemWriter`.
    noted : Out(1), steps : Out(32)
        A run was begun, of so many steps, or ended (0).
    port : Out(HostAccess)
    """

    def __init__(self, state: int):
        self._items = items = Items.of_word(state)
        self._farthest = PAYLOAD_MOST + items.bytes * HEAD["count"].raw_max  # the end if words of a write are missing
        super().__init__(
            {
                "look": In(1),
                "walk": In(1),
                "done": Out(1),
                "bad": Out(1),
                "refused": Out(1),
                "greets": In(1),
                "length": In(range(PAYLOAD_MOST + 1)),
                "place": Out(range(PAYLOAD_MOST)),
                "byte": In(8),
                "item_valid": Out(1),
                "item": Out(8 * items.bytes),
                "item_ready": In(1),
                "noted": Out(1),
                "steps": Out(32),
                "port": Out(HostAccess(state)),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.crc = self._crc = CRC(data_width=8).create()
        # only looked through; the item is a word to be written
        self._dry = Signal(name="dry")
        self._writes = Signal(name="writes")
        self._position = Signal(range(self._farthest + 1), name="position")
        self._given = Signal(range(1 << 15), name="given")
        self._word = Signal.like(self.item, name="word")
        self._number = Signal(3, name="number")
        self._wait = Signal(range(READ_LATENCY + 1), name="wait")
        self._segment = {name: Signal(q.width, name=name) for name, q in HEAD.items()}
        self._compared(m)
        m.d.comb += [self.place.eq(self._position), self._crc.data.eq(self._word)]
        with m.FSM():
            self._payload(m)
            self._words(m)
        return m

    def _compared(self, m):
        """In registers: right from the second cycle on after what is compared has changed."""
        self._through = Signal(name="through")
        self._short = Signal(name="short")
        self._too_many = Signal(name="too_many")
        self._extent = Signal(range(self._farthest + 1), name="extent")
        self._runs = Signal(name="runs")
        self._stops = Signal(name="stops")
        address, size = self._segment["address"], self._items.bytes
        m.d.sync += [
            self._through.eq(self._position == self.length),
            self._short.eq(self._position + self._items.bytes > self.length),
            self._too_many.eq(self._given > self._items.answer_most),
            self._extent.eq(  # without a multiplier
                sum(self._segment["count"] << n for n in range(size.bit_length()) if size >> n & 1)
            ),
            self._runs.eq(address == _control(Control.RUN)),
            self._stops.eq(address == _control(Control.STOP)),
        ]

    def _finish(self, m, bad=0):
        m.d.comb += [self.done.eq(1), self.bad.eq(bad)]
        m.next = "idle"

    def _gather(self, m, writes):
        m.d.sync += [self._writes.eq(writes), self._number.eq(0), self._wait.eq(READ_LATENCY)]
        m.next = "gather"

    def _payload(self, m):
        kind, count = self._segment["kind"], self._segment["count"]
        with m.State("idle"):
            m.d.sync += [self._position.eq(0), self._given.eq(0), self._dry.eq(self.look)]
            with m.If(self.look):
                m.d.sync += self.refused.eq(0)
                m.next = "between"
                with m.If(self.greets):
                    m.next = "greeting"
            with m.Elif(self.walk):
                m.next = "between"
        with m.State("greeting"):
            self._finish(m, self.length != GREETING_BYTES)
        with m.State("between"):
            m.next = "segment"
        with m.State("segment"):
            m.d.comb += self._crc.start.eq(1)
            with m.If(self._through):
                self._finish(m, self._too_many)
            with m.Elif(self._short):
                self._finish(m, 1)
            with m.Else():
                self._gather(m, writes=0)
        with m.State("gather"):
            m.d.sync += self._wait.eq(self._wait - 1)
            with m.If(self._wait == 0):
                m.d.sync += [self._word.eq(Cat(self._word[8:], self.byte)), self._position.eq(self._position + 1)]
                m.d.sync += [self._number.eq(self._number + 1), self._wait.eq(READ_LATENCY)]
                with m.If(self._number == self._items.bytes - 1):
                    m.next = "head"
                    with m.If(self._writes):
                        m.next = "access"
        with m.State("head"):
            m.d.sync += [self._segment[name].eq(part) for name, part in HEAD.unpack(self._word).items()]
            m.next = "words"
            with m.If(self._dry):
                m.next = "measure"
            with m.If(self.greets):
                m.next = "give"
        with m.State("measure"):
            m.next = "room"
        with m.State("room"):
            m.next = "between"
            with m.Switch(kind):
                with m.Case(Kind.READ):
                    m.d.sync += self._given.eq(self._given + count)
                with m.Case(Kind.CHECK):
                    m.d.sync += self._given.eq(self._given + 1)
                with m.Case(Kind.WRITE):
                    m.d.sync += self._position.eq(self._position + self._extent)
                with m.Default():
                    self._finish(m, 1)

    def _words(self, m):
        address, across, kind, count = (self._segment[name] for name in ("address", "across", "kind", "count"))
        m.d.comb += [
            self.port.write.eq(kind == Kind.WRITE),
            self.port.address.eq(address),
            self.port.write_data.eq(self._word),
            self.item.eq(self._word),
            self.steps.eq(Mux(self._runs, self._word, 0)),
        ]
        with m.State("words"):
            with m.If(count != 0):
                m.next = "access"
                with m.If(kind == Kind.WRITE):
                    self._gather(m, writes=1)
            with m.Elif(kind == Kind.CHECK):
                m.d.sync += self._word.eq(self._crc.crc)
                m.next = "give"
            with m.Else():
                m.next = "between"
        with m.State("access"):
            m.d.comb += self.port.request.eq(1)
            m.next = "accessed"
        with m.State("accessed"):
            with m.If(self.port.answer):
                m.d.sync += [count.eq(count - 1), self.refused.eq(self.refused | self.port.error)]
                self._next(m, address, across)
                m.next = "words"
                with m.If(kind != Kind.WRITE):
                    m.d.sync += [self._word.eq(self.port.read_data), self._number.eq(0)]
                    m.next = "give"
                    with m.If(kind == Kind.CHECK):
                        m.next = "sum"
                m.d.comb += self.noted.eq((kind == Kind.WRITE) & ~self.port.error & (self._runs | self._stops))
        with m.State("sum"):
            m.d.comb += self._crc.valid.eq(1)
            m.d.sync += [self._word.eq(self._word >> 8), self._number.eq(self._number + 1)]
            with m.If(self._number == self._items.bytes - 1):
                m.next = "words"
        with m.State("give"):
            m.d.comb += self.item_valid.eq(1)
            with m.If(self.item_ready):
                m.next = "between"
                with m.If((kind == Kind.READ) & ~self.greets):
                    m.next = "words"
                with m.If(self.greets):  # the rest of its payload means nothing
                    self._finish(m)

    def _next(self, m, address, across):
        """Within its field: a segment that is too long meets its own beginning, and nothing else."""
        index, word = ADDRESS.field("index", address), ADDRESS.field("word", address)
        with m.If(across):
            m.d.sync += word.eq(word + 1)
        with m.Else():
            m.d.sync += index.eq(index + 1)


def _control(register):
    return join(Region.CONTROL, 0, register, 0)
