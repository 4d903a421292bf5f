"""Commands that came, done one after the other on the host port, and their answers."""

from amaranth.hdl import Array, Cat, Const, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped

from hw.link.frame import ANSWER, HEADER
from hw.link.interfaces import ByteStream, ReceivedBytes
from hw.link.item_writer import ItemWriter
from hw.link.items import Items
from hw.link.pause import Pause
from hw.link.protocol import BUSY, WINDOW, Operation, Status
from hw.link.receive import FrameReceiver
from hw.link.registers import LINK, LinkRegisters
from hw.link.send import FrameSender
from hw.link.walk import Walker
from hw.machine.interfaces import HostBus
from hw.map.control import Control
from hw.map.memory_map import ADDRESS, Region, join


def members(state: int) -> dict:
    """Return the ports of a device, for words of ``state`` bits."""
    return {
        "received": In(ReceivedBytes()),
        "sent": Out(ByteStream()),
        "port": Out(HostBus(state)),
    }


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

    Raises
    ------
    ValueError
        If an item cannot hold a word, or one of the identity.

    Members
    -------
    received : In(ReceivedBytes)
    sent : Out(ByteStream)
    port : Out(HostBus)
    """

    def __init__(self, *, key: bytes, identity: list[int], state: int):
        self._key, self._identity, self._state, self._items = key, identity, state, Items.of_word(state)
        for item in identity:
            self._items.pack(item)
        super().__init__(members(state))

    def elaborate(self, platform):
        m = Module()
        m.submodules.receiver = self._receiver = receiver = FrameReceiver(self._key)
        m.submodules.sender = self._sender = sender = FrameSender(self._key)
        m.submodules.writer = self._writer = writer = ItemWriter(self._items)
        m.submodules.walker = self._walker = walker = Walker(self._state)
        m.submodules.pauser = self._pauser = pauser = Pause(self._state)
        m.submodules.registers = self._registers = registers = LinkRegisters(self._state)
        self._greets = Signal(name="greets")
        self._exchanges = Signal(name="exchanges")
        self._accesses = Signal(name="accesses")
        m.d.sync += [
            self._greets.eq(receiver.type == Operation.HELLO),
            self._exchanges.eq(receiver.type == Operation.EXCHANGE),
            self._accesses.eq(receiver.type == Operation.ACCESS),
        ]
        m.d.comb += [
            sender.answer.eq(receiver.seq),
            sender.write_answer.eq(receiver.seq),
            receiver.place.eq(walker.place),
            walker.greets.eq(self._greets),
            walker.length.eq(receiver.length),
            walker.byte.eq(receiver.byte),
            walker.item_ready.eq(writer.ready),
            pauser.noted.eq(walker.noted),
            pauser.steps.eq(walker.steps),
            pauser.busy.eq(self.port.busy),
            registers.busy.eq(self.port.busy),
        ]
        connect(m, flipped(self.received), receiver.received)
        connect(m, sender.sent, flipped(self.sent))
        connect(m, receiver.events, registers.frames)
        self._faults = Signal()  # they are asked for
        self._port(m)
        self._commands(m)
        return m

    def _port(self, m):
        """Who of them uses the host port does so alone; the link's own registers answer beside it. Registers on both
        ways: the circuit is large, and may be far away."""
        walker, pauser, registers = self._walker, self._pauser, self._registers
        own = ADDRESS.field("region", walker.port.address) == LINK
        m.d.comb += [
            registers.request.eq(walker.port.request & own),
            registers.write.eq(walker.port.write),
            registers.index.eq(ADDRESS.field("index", walker.port.address)),
            registers.data.eq(walker.port.write_data),
        ]
        m.d.sync += self.port.request.eq(pauser.port.request | self._faults | walker.port.request & ~own)
        with m.If(pauser.port.request):
            m.d.sync += _request(self.port).eq(_request(pauser.port))
        with m.Elif(self._faults):
            m.d.sync += [self.port.write.eq(0), self.port.address.eq(join(Region.CONTROL, 0, Control.FAULTS, 0))]
        with m.Else():
            m.d.sync += _request(self.port).eq(_request(walker.port))
        given = Signal(len(_answer(self.port)), name="given_answer")
        m.d.sync += given.eq(Mux(registers.answer, _answer(registers), _answer(self.port)))
        m.d.comb += [_answer(pauser.port).eq(given), _answer(walker.port).eq(given)]

    def _commands(self, m):
        with m.FSM():
            self._choice(m)
            self._doing(m)
            self._answering(m)

    def _ends(self, m, status):
        m.d.sync += self._status.eq(status)
        m.next = "faults"

    def _choice(self, m):
        """Take a command, answer it again or drop it, by its seq."""
        receiver, sender, registers, greets = self._receiver, self._sender, self._registers, self._greets
        self._session = Signal(name="session")
        self._expected = Signal(8, name="expected")
        self._status = Signal(Status, name="status")
        early = Signal(8)
        due = Signal()
        done = Signal()
        free = Signal()
        m.d.comb += early.eq(receiver.seq - self._expected)
        m.d.sync += [
            due.eq(greets | ~self._session | (early == 0)),
            done.eq(early >= 256 - WINDOW),
            free.eq(~sender.waits.bit_select(receiver.seq[: len(sender.answer)], 1)),
        ]
        with m.State("idle"):
            m.d.comb += [self._writer.begin.eq(1), self._writer.at.eq(HEADER.size + self._items.bytes)]
            m.d.sync += self._status.eq(Status.DONE)
            with m.If(registers.halt):
                m.next = "halt"
            with m.Elif(receiver.frame):
                m.next = "comparison"
        with m.State("comparison"):
            m.next = "choice"
        with m.State("choice"):
            m.next = "idle"
            with m.If(due & free):
                m.d.comb += self._walker.look.eq(1)
                m.next = "looking"
            with m.Elif(~due):
                m.d.comb += [sender.send.eq(done), receiver.take.eq(1)]
                m.d.comb += [registers.duplicates.eq(done), registers.gaps.eq(~done)]
        with m.State("halt"):
            m.d.comb += self._pauser.halt.eq(1)
            m.next = "halting"
        with m.State("halting"):
            with m.If(self._pauser.done):
                m.d.comb += registers.halted.eq(1)
                m.next = "idle"

    def _doing(self, m):
        receiver, walker, pauser = self._receiver, self._walker, self._pauser
        with m.State("looking"):
            with m.If(walker.done):
                with m.If(~self._greets & ~self._session):
                    self._ends(m, Status.STRANGER)
                with m.Elif(~self._greets & ~self._exchanges & ~self._accesses):
                    self._ends(m, Status.UNKNOWN)
                with m.Elif(walker.bad):
                    self._ends(m, Status.MALFORMED)
                with m.Else():
                    m.next = "walk"
                    with m.If(self._greets):
                        m.d.sync += [self._session.eq(1), self._expected.eq(receiver.seq)]
                    with m.If(self._exchanges & self.port.busy):
                        m.next = "pause"
        with m.State("pause"):
            m.d.comb += pauser.pause.eq(1)
            m.next = "pausing"
        with m.State("pausing"):
            with m.If(pauser.done):
                m.next = "walk"
        with m.State("walk"):
            m.d.comb += walker.walk.eq(1)
            m.next = "walking"
        with m.State("walking"):
            with m.If(walker.done):
                m.next = "faults"
                with m.If(self._greets):
                    m.next = "identity"
                with m.If(walker.refused):
                    m.d.sync += self._status.eq(Status.REFUSED)
                with m.If(self._exchanges):
                    m.next = "resume"
        with m.State("resume"):
            m.d.comb += pauser.resume.eq(1)
            m.next = "resuming"
        with m.State("resuming"):
            with m.If(pauser.done):
                m.next = "faults"

    def _answering(self, m):
        """Identity, faults and header; what was read stands in the answer already."""
        receiver, sender, writer, walker = self._receiver, self._sender, self._writer, self._walker
        told = Signal(range(len(self._identity) + 1))
        faults = Signal(self._state)
        length = Signal.like(sender.length)
        gives = Signal()
        heads = Signal()
        number = Signal(range(HEADER.size))
        header = Signal(8)
        item = Signal.like(writer.item)
        identity = Array(Const(part, len(writer.item)) for part in self._identity)
        size, payload, status = self._items.bytes, length - HEADER.size, self._status | Mux(self.port.busy, BUSY, 0)
        m.d.comb += [
            item.eq(faults),
            writer.valid.eq(walker.item_valid | gives),
            writer.item.eq(Mux(gives, item, walker.item)),
            sender.write.eq(writer.write | heads),
            sender.write_place.eq(Mux(heads, number, writer.place)),
            sender.write_data.eq(Mux(heads, header, writer.data)),
            header.eq(Array([receiver.type | ANSWER, receiver.seq, status, size, payload[:8], payload[8:]])[number]),
        ]
        with m.State("identity"):
            m.d.comb += [item.eq(identity[told]), gives.eq(1)]
            with m.If(writer.ready):
                m.d.sync += told.eq(told + 1)
                with m.If(told == len(self._identity) - 1):
                    m.next = "faults"
        with m.State("faults"):
            m.d.sync += told.eq(0)
            with m.If(writer.ready):
                m.d.comb += self._faults.eq(1)
                m.next = "faulty"
        with m.State("faulty"):
            m.d.comb += writer.at.eq(HEADER.size)
            with m.If(walker.port.answer):
                m.d.sync += [faults.eq(walker.port.read_data), length.eq(writer.place), number.eq(0)]
                m.d.comb += writer.begin.eq(1)
                m.next = "seal"
        with m.State("seal"):
            m.d.comb += gives.eq(1)
            with m.If(writer.ready):
                m.next = "header"
        with m.State("header"):
            with m.If(writer.ready):
                m.d.comb += heads.eq(1)
                m.d.sync += number.eq(number + 1)
                with m.If(number == HEADER.size - 1):
                    m.next = "send"
        with m.State("send"):
            m.d.comb += [sender.send.eq(1), sender.length.eq(length), receiver.take.eq(1)]
            m.d.sync += self._expected.eq(self._expected + self._session)
            m.next = "idle"


def _request(port) -> Value:
    return Cat(port.write, port.address, port.write_data)


def _answer(port) -> Value:
    return Cat(port.answer, port.error, port.read_data)
