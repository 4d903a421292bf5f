"""Commands that came, done one after the other on the host port, and their answers."""

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.enum import Enum
from amaranth.lib.wiring import In, Out

from ..blocks.memory import READ_LATENCY
from ..host import host_signature
from ..registers import INDEX_BITS, Control, Region, join
from .frame import ANSWER, CRC, HEADER
from .protocol import BUSY, HEAD, ITEM_BYTES, ITEMS_MOST, WINDOW, Kind, Operation, Status
from .receive import FrameReceiver
from .send import FrameSender


class After(Enum):
    """Where it goes on behind an item of the payload, or of the answer."""

    GREET = 0
    HEAD = 1
    WORD = 2
    WORDS = 3
    SEGMENT = 4
    IDENTITY = 5
    SEAL = 6


class Device(wiring.Component):
    """Does what `hw.link.protocol` says.

    A command's seq is one more than that of the one before. One that was done already is answered again, from what was
    kept; one that comes too early is dropped, and so is everything before a greeting but for an answer that says so.
    Each is done as a whole before the next, and not at all if its payload isn't what it should be.

    Parameters
    ----------
    key : bytes
    identity : list of int
        Items of the answer to a greeting.
    state : int
        Bits of a word.

    Members
    -------
    valid, data, error, broken : In
        From a `hw.link.uart.Receiver`.
    out_valid, out_data, out_ready
        To a `hw.link.uart.Transmitter`.
    port_...: request, write, address, write_data : Out; answer, error, read_data : In
        To the host port: `hw.host`.
    busy : In(1)
    """

    def __init__(self, *, key: bytes, identity: list[int], state: int):
        self._key, self._identity = key, identity
        port = {f"port_{name}": member.flip() for name, member in host_signature(state).items()}
        super().__init__(
            {
                "valid": In(1),
                "data": In(8),
                "error": In(1),
                "broken": In(1),
                "out_valid": Out(1),
                "out_data": Out(8),
                "out_ready": In(1),
                "busy": In(1),
                **port,
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.receiver = self._receiver = receiver = FrameReceiver(self._key)
        m.submodules.sender = self._sender = sender = FrameSender(self._key)
        m.d.comb += [
            *(getattr(receiver, name).eq(getattr(self, name)) for name in ("valid", "data", "error", "broken")),
            self.out_valid.eq(sender.valid),
            self.out_data.eq(sender.data),
            sender.ready.eq(self.out_ready),
        ]
        self._registers(m)
        with m.FSM():
            self._choice(m)
            self._segments(m)
            self._words(m)
            self._pauses(m)
            self._endings(m)
        return m

    def _registers(self, m):
        self._session, self._expected = Signal(), Signal(8)
        self._status, self._refused = Signal(Status), Signal()
        self._dry = Signal()  # the payload is looked through before anything is done
        self._position = Signal(range(2048))  # in the payload; behind it, if a write lacks words
        self._given = Signal(range(1 << 15))  # items of the answer
        self._item, self._number, self._wait = Signal(8 * ITEM_BYTES), Signal(3), Signal(range(READ_LATENCY + 1))
        self._segment = {name: Signal(bits, name=name) for name, bits in HEAD.items()}
        self._steps, self._left = Signal(32), Signal(32)
        self._after, self._place = Signal(After), Signal.like(self._sender.write_place)
        m.submodules.crc = self._crc = CRC(data_width=8).create()
        m.d.comb += [
            self._receiver.place.eq(self._position),
            self._sender.answer.eq(self._receiver.seq),
            self._sender.write_answer.eq(self._receiver.seq),
            self._sender.write_place.eq(self._place),
            self._crc.data.eq(self._item),
        ]
        m.d.sync += self._wait.eq(Mux(self._wait == 0, 0, self._wait - 1))

    def _fails(self, m, status):
        m.d.sync += self._status.eq(status)
        m.next = "faults"

    def _gather(self, m, following):
        """An item of the payload, then another state."""
        m.d.sync += [self._after.eq(following), self._number.eq(0), self._wait.eq(READ_LATENCY)]
        m.next = "gather"

    def _emit(self, m, item, following):
        """An item of the answer, then another state."""
        m.d.sync += [self._after.eq(following), self._number.eq(0), self._item.eq(item)]
        m.next = "emit"

    def _ask(self, m, register, following, write=None):
        """An access to a control register; the next state waits for its answer."""
        m.d.comb += [self.port_request.eq(1), self.port_address.eq(join(Region.CONTROL, 0, register, 0))]
        if write is not None:
            m.d.comb += [self.port_write.eq(1), self.port_write_data.eq(write)]
        m.next = following

    def _choice(self, m):
        """What becomes of a command, by its seq."""
        receiver, sender = self._receiver, self._sender
        early, free = Signal(8), Signal()
        m.d.comb += early.eq(receiver.seq - self._expected)
        m.d.comb += free.eq(~sender.waits.bit_select(receiver.seq[: len(sender.answer)], 1))
        greets = receiver.type == Operation.HELLO
        with m.State("idle"):
            m.d.sync += [self._position.eq(0), self._given.eq(0), self._dry.eq(1), self._left.eq(0)]
            m.d.sync += [self._status.eq(Status.DONE), self._refused.eq(0), self._place.eq(HEADER.size + ITEM_BYTES)]
            with m.If(receiver.frame & (greets | ~self._session | (early == 0))):
                with m.If(free):
                    m.next = "begin"
            with m.Elif(receiver.frame):
                m.d.comb += [sender.send.eq(early >= 256 - WINDOW), receiver.take.eq(1)]
        with m.State("begin"):
            with m.If(greets):
                m.d.sync += [self._session.eq(1), self._expected.eq(receiver.seq)]
                with m.If(receiver.length == ITEM_BYTES):
                    self._gather(m, After.GREET)
                with m.Else():
                    self._fails(m, Status.MALFORMED)
            with m.Elif(~self._session):
                self._fails(m, Status.STRANGER)
            with m.Elif((receiver.type == Operation.ACCESS) | (receiver.type == Operation.EXCHANGE)):
                m.next = "segment"
            with m.Else():
                self._fails(m, Status.UNKNOWN)

    def _segments(self, m):
        receiver, segment = self._receiver, self._segment
        kind, count = segment["kind"], segment["count"]
        with m.State("segment"):
            m.d.comb += self._crc.start.eq(1)
            with m.If(self._position == receiver.length):
                m.d.sync += [self._dry.eq(0), self._position.eq(0)]
                with m.If(~self._dry):
                    m.next = "resume"
                with m.Elif(self._given > ITEMS_MOST):
                    self._fails(m, Status.MALFORMED)
                with m.Elif((receiver.type == Operation.EXCHANGE) & self.busy):
                    m.next = "pause"
            with m.Elif(self._position + ITEM_BYTES > receiver.length):
                self._fails(m, Status.MALFORMED)
            with m.Else():
                self._gather(m, After.HEAD)
        with m.State("gather"):
            with m.If(self._wait == 0):
                m.d.sync += [self._item.eq(Cat(self._item[8:], receiver.byte)), self._position.eq(self._position + 1)]
                m.d.sync += [self._number.eq(self._number + 1), self._wait.eq(READ_LATENCY)]
                with m.If(self._number == ITEM_BYTES - 1):
                    with m.Switch(self._after):
                        for after, state in ((After.GREET, "greet"), (After.HEAD, "head"), (After.WORD, "access")):
                            with m.Case(after):
                                m.next = state
        with m.State("head"):
            m.d.sync += Cat(segment.values()).eq(self._item)
            m.next = "words"
            with m.If(self._dry):
                m.next = "room"
        with m.State("room"):
            m.next = "segment"
            with m.Switch(kind):
                with m.Case(Kind.READ):
                    m.d.sync += self._given.eq(self._given + count)
                with m.Case(Kind.CHECK):
                    m.d.sync += self._given.eq(self._given + 1)
                with m.Case(Kind.WRITE):
                    m.d.sync += self._position.eq(self._position + ITEM_BYTES * count)
                with m.Default():
                    self._fails(m, Status.MALFORMED)

    def _words(self, m):
        address, across, kind, count = (self._segment[name] for name in ("address", "across", "kind", "count"))
        with m.State("words"):
            with m.If(count != 0):
                m.next = "access"
                with m.If(kind == Kind.WRITE):
                    self._gather(m, After.WORD)
            with m.Elif(kind == Kind.CHECK):
                self._emit(m, self._crc.crc, After.SEGMENT)
            with m.Else():
                m.next = "segment"
        with m.State("access"):
            m.d.comb += [self.port_request.eq(1), self.port_write.eq(kind == Kind.WRITE)]
            m.d.comb += [self.port_address.eq(address), self.port_write_data.eq(self._item)]
            m.next = "accessed"
        with m.State("accessed"):
            with m.If(self.port_answer):
                m.d.sync += [count.eq(count - 1), self._refused.eq(self._refused | self.port_error)]
                m.d.sync += address.eq(address + Mux(across, 1 << INDEX_BITS, 1))
                m.next = "words"
                with m.If(kind == Kind.READ):
                    self._emit(m, self.port_read_data, After.WORDS)
                with m.Elif(kind == Kind.CHECK):
                    m.d.sync += [self._item.eq(self.port_read_data), self._number.eq(0)]
                    m.next = "sum"
                with m.Elif(~self.port_error):
                    self._note(m, address)
        with m.State("sum"):
            m.d.comb += self._crc.valid.eq(1)
            m.d.sync += [self._item.eq(self._item >> 8), self._number.eq(self._number + 1)]
            with m.If(self._number == ITEM_BYTES - 1):
                m.next = "words"
        with m.State("emit"):
            m.d.comb += [self._sender.write.eq(1), self._sender.write_data.eq(self._item)]
            m.d.sync += [self._item.eq(self._item >> 8), self._number.eq(self._number + 1)]
            m.d.sync += self._place.eq(self._place + 1)
            with m.If(self._number == ITEM_BYTES - 1):
                m.d.sync += self._number.eq(0)
                with m.Switch(self._after):
                    for after in (After.WORDS, After.SEGMENT, After.IDENTITY, After.SEAL):
                        with m.Case(after):
                            m.next = after.name.lower()

    def _note(self, m, address):
        """What the host says about the run itself holds, whatever was to go on."""
        for register, steps in ((Control.RUN, self._item), (Control.STOP, 0)):
            with m.If(address == join(Region.CONTROL, 0, register, 0)):
                m.d.sync += [self._steps.eq(steps), self._left.eq(0)]

    def _pauses(self, m):
        """A run is stopped with its step, and what is left of it is run afterwards."""
        with m.State("pause"):
            self._ask(m, Control.STOP, "stopping", write=1)
        with m.State("stopping"):
            with m.If(self.port_answer):
                m.next = "paused"
        with m.State("paused"):
            with m.If(~self.busy):
                self._ask(m, Control.STEPS_DONE, "counted")
        with m.State("counted"):
            with m.If(self.port_answer):
                done = self.port_read_data[: len(self._steps)]
                m.d.sync += self._left.eq(Mux(self._steps > done, self._steps - done, 0))
                m.next = "segment"
        with m.State("resume"):
            m.next = "faults"
            with m.If(self._left != 0):
                m.d.sync += self._steps.eq(self._left)
                self._ask(m, Control.RUN, "resumed", write=self._left)
        with m.State("resumed"):
            with m.If(self.port_answer):
                m.next = "faults"

    def _endings(self, m):
        receiver, sender = self._receiver, self._sender
        told, length = Signal(range(len(self._identity) + 1)), Signal.like(sender.length)
        identity = Array(Const(item, len(self._item)) for item in [*self._identity, 0])
        with m.State("greet"):
            m.d.sync += told.eq(0)
            self._emit(m, self._item, After.IDENTITY)
        with m.State("identity"):
            m.d.sync += told.eq(told + 1)
            m.next = "faults"
            with m.If(told != len(self._identity)):
                self._emit(m, identity[told], After.IDENTITY)
        with m.State("faults"):
            self._ask(m, Control.FAULTS, "faulty")
        with m.State("faulty"):
            with m.If(self.port_answer):
                m.d.sync += [length.eq(self._place), self._place.eq(HEADER.size)]
                self._emit(m, self.port_read_data, After.SEAL)
        with m.State("seal"):
            m.d.sync += self._place.eq(0)
            m.next = "header"
        payload, refused = length - HEADER.size, self._refused & (self._status == Status.DONE)
        status = Mux(refused, Status.REFUSED, self._status) | Mux(self.busy, BUSY, 0)
        header = Array([receiver.type | ANSWER, receiver.seq, status, 0, payload[:8], payload[8:]])
        with m.State("header"):
            m.d.comb += [sender.write.eq(1), sender.write_data.eq(header[self._number])]
            m.d.sync += [self._number.eq(self._number + 1), self._place.eq(self._place + 1)]
            with m.If(self._number == HEADER.size - 1):
                m.next = "send"
        with m.State("send"):
            m.d.comb += [sender.send.eq(1), sender.length.eq(length), receiver.take.eq(1)]
            m.d.sync += self._expected.eq(self._expected + self._session)
            m.next = "idle"
