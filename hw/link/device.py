"""Take commands one after another, do them on the host port, and answer them."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out, connect, flipped

from hw.link.answer import AnswerWriter
from hw.link.interfaces import ByteStream, ReceivedBytes
from hw.link.items import Items
from hw.link.order import CommandOrder
from hw.link.pause import Pause
from hw.link.port import PortSwitch
from hw.link.protocol import BUSY, Operation, Status
from hw.link.receive import FrameReceiver
from hw.link.registers import LinkRegisters
from hw.link.send import FrameSender
from hw.link.states import check_states
from hw.link.walk import Walker
from hw.machine.interfaces import HostBus

COMMAND = "idle", "comparison", "choice", "walk", "send"
"""States of every command that is done, one cycle each."""
EXCHANGE = "pause", "resume"
"""States of an exchange besides, one cycle each."""
HALT = ("halt",)
LASTING = "checking", "pausing", "walking", "resuming", "answering", "halting"
"""States in which a component works, until it is done."""


def members(state: int) -> dict:
    """Return the ports of a device, for words of ``state`` bits."""
    return {
        "received": In(ReceivedBytes()),
        "sent": Out(ByteStream()),
        "port": Out(HostBus(state)),
    }


class Device(wiring.Component):
    """Answer commands according to `hw.link.protocol`.

    A command's sequence number is one more than that of the one before. A command that was done before is answered from
    its kept answer; one that comes too early is dropped. Before a greeting, a command does nothing, and its answer says
    so. Each command is checked as a whole before any of it is done, and done before the next one is looked at.

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
        items = Items.of_word(state)
        for item in identity:
            items.pack(item)
        super().__init__(members(state))
        self._receiver = FrameReceiver(key)
        self._order = CommandOrder()
        self._walker = Walker(state)
        self._pauser = Pause(state)
        self._answer = AnswerWriter(items, identity, state)
        self._sender = FrameSender(key)
        self._switch = PortSwitch(state)
        self._registers = LinkRegisters(state)
        self._greets = Signal(name="greets")
        self._exchanges = Signal(name="exchanges")
        self._accesses = Signal(name="accesses")
        self._status = Signal(Status, name="status")

    def elaborate(self, platform):
        m = Module()
        m.submodules.receiver = receiver = self._receiver
        m.submodules.order = self._order
        m.submodules.walker = self._walker
        m.submodules.pauser = self._pauser
        m.submodules.answer = self._answer
        m.submodules.sender = self._sender
        m.submodules.switch = self._switch
        m.submodules.registers = self._registers
        m.d.sync += [
            self._greets.eq(receiver.type == Operation.HELLO),
            self._exchanges.eq(receiver.type == Operation.EXCHANGE),
            self._accesses.eq(receiver.type == Operation.ACCESS),
        ]
        self._join(m)
        self._join_answer(m)
        with m.FSM() as machine:
            self._take(m)
            self._halt(m)
            self._check(m)
            self._do(m)
            self._send(m)
        check_states(machine.encoding, COMMAND, EXCHANGE, HALT, LASTING)
        return m

    def _join(self, m: Module):
        receiver, walker, pauser, switch = self._receiver, self._walker, self._pauser, self._switch
        connect(m, flipped(self.received), receiver.received)
        connect(m, receiver.events, self._registers.frames)
        connect(m, self._sender.sent, flipped(self.sent))
        connect(m, walker.port, switch.walker)
        connect(m, pauser.port, switch.pause)
        connect(m, switch.registers, self._registers.port)
        connect(m, switch.port, flipped(self.port))
        m.d.comb += [
            self._order.seq.eq(receiver.seq),
            self._order.greets.eq(self._greets),
            self._order.waits.eq(self._sender.waits),
            receiver.index.eq(walker.index),
            walker.length.eq(receiver.length),
            walker.byte.eq(receiver.byte),
            walker.greets.eq(self._greets),
            pauser.noted.eq(walker.noted),
            pauser.steps.eq(walker.steps),
            pauser.busy.eq(self.port.busy),
            self._registers.busy.eq(self.port.busy),
        ]

    def _join_answer(self, m: Module):
        receiver, answer, sender, switch = self._receiver, self._answer, self._sender, self._switch
        connect(m, self._walker.items, answer.stream)
        m.d.comb += [
            answer.type.eq(receiver.type),
            answer.seq.eq(receiver.seq),
            answer.status.eq(self._status | Mux(self.port.busy, BUSY, 0)),
            switch.ask_faults.eq(answer.ask_faults),
            answer.answered.eq(switch.walker.answer),
            answer.faults.eq(switch.walker.read_data),
            sender.write.eq(answer.write),
            sender.write_answer.eq(receiver.seq),
            sender.write_index.eq(answer.index),
            sender.write_data.eq(answer.data),
            sender.answer.eq(receiver.seq),
        ]

    def _take(self, m: Module):
        """Take a command, answer it again, or drop it."""
        order, registers = self._order, self._registers
        with m.State("idle"):
            m.d.comb += self._answer.begin.eq(1)
            m.d.sync += self._status.eq(Status.DONE)
            with m.If(registers.halt):
                m.next = "halt"
            with m.Elif(self._receiver.frame):
                m.next = "comparison"
        with m.State("comparison"):
            m.next = "choice"
        with m.State("choice"):
            m.next = "idle"
            with m.If(order.due & order.free):
                m.d.comb += self._walker.check.eq(1)
                m.next = "checking"
            with m.Elif(~order.due):
                m.d.comb += [self._sender.send.eq(order.done), self._receiver.take.eq(1)]
                m.d.comb += [registers.duplicates.eq(order.done), registers.gaps.eq(~order.done)]

    def _halt(self, m: Module):
        with m.State("halt"):
            m.d.comb += self._pauser.halt.eq(1)
            m.next = "halting"
        with m.State("halting"):
            with m.If(self._pauser.done):
                m.d.comb += self._registers.halted.eq(1)
                m.next = "idle"

    def _finish(self, m: Module, *, greeting=0):
        m.d.comb += [self._answer.finish.eq(1), self._answer.greeting.eq(greeting)]
        m.next = "answering"

    def _refuse(self, m: Module, status: Status):
        m.d.sync += self._status.eq(status)
        self._finish(m)

    def _check(self, m: Module):
        with m.State("checking"):
            with m.If(self._walker.done):
                with m.If(~self._greets & ~self._order.session):
                    self._refuse(m, Status.STRANGER)
                with m.Elif(~self._greets & ~self._exchanges & ~self._accesses):
                    self._refuse(m, Status.UNKNOWN)
                with m.Elif(self._walker.bad):
                    self._refuse(m, Status.MALFORMED)
                with m.Else():
                    m.d.comb += self._order.begin.eq(self._greets)
                    m.next = "walk"
                    with m.If(self._exchanges & self.port.busy):
                        m.next = "pause"

    def _do(self, m: Module):
        walker, pauser = self._walker, self._pauser
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
                with m.If(walker.refused):
                    m.d.sync += self._status.eq(Status.REFUSED)
                with m.If(self._exchanges):
                    m.next = "resume"
                with m.Else():
                    self._finish(m, greeting=self._greets)
        with m.State("resume"):
            m.d.comb += pauser.resume.eq(1)
            m.next = "resuming"
        with m.State("resuming"):
            with m.If(pauser.done):
                self._finish(m)

    def _send(self, m: Module):
        with m.State("answering"):
            with m.If(self._answer.done):
                m.next = "send"
        with m.State("send"):
            m.d.comb += [self._sender.send.eq(1), self._sender.length.eq(self._answer.length)]
            m.d.comb += [self._receiver.take.eq(1), self._order.advance.eq(1)]
            m.next = "idle"
