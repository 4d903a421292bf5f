"""Write a command's answer: first what was read, then the faults and the header."""

from amaranth.hdl import Array, Const, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.frame import ANSWER, HEADER
from hw.link.interfaces import ItemStream
from hw.link.item_writer import ItemWriter
from hw.link.items import Items
from hw.link.port import LATENCY
from hw.link.send import ANSWER_MOST
from hw.link.states import check_states

WRITING = "idle", "identity"
"""States before an answer is finished. ``identity`` lasts until all items of the identity are taken."""
FINISH = "faults", "faults_asked", "faults_item"
"""States of the faults: ``faults`` waits until all items are written, ``faults_asked`` for the answer."""
HEAD = ("header",)
"""State of the header, a cycle a byte. It waits until the faults are written."""


def finish_cycles(items: Items) -> int:
    """Return the cycles from ``finish``, in the next cycle, to ``done``, at most; not of a greeting."""
    waits = items.bytes  # for the last item, and for that of the faults
    return len(FINISH) - 1 + LATENCY + len(HEAD) * HEADER.size + 2 * waits


class AnswerWriter(wiring.Component):
    """Write an answer into a `hw.link.send.FrameSender`: items as they come, and on ``finish`` the rest.

    The faults go before all other items and the header before the faults, though both are known last.

    Parameters
    ----------
    items : Items
    identity : list of int
        Items of the answer to a greeting, after those that came.
    state : int
        Bits of a word.

    Members
    -------
    begin : In(1)
        A new answer.
    stream : In(ItemStream)
        Its items.
    finish : In(1), greeting : In(1)
        Write the rest, with the identity if ``greeting``.
    type : In(8), seq : In(8), status : In(8)
        For the header: the command's type and number, and the status; held from ``finish`` to ``done``.
    ask_faults : Out(1), answered : In(1), faults : In
        A request for the faults, and its answer.
    write : Out(1), index : Out, data : Out(8)
        A byte of the answer.
    done : Out(1), length : Out
        The answer is written, and has so many bytes.
    """

    def __init__(self, items: Items, identity: list[int], state: int):
        self._items, self._identity, self._state = items, identity, state
        super().__init__(
            {
                **{name: In(1) for name in ("begin", "finish", "greeting", "answered")},
                **{name: In(8) for name in ("type", "seq", "status")},
                "stream": In(ItemStream(8 * items.bytes)),
                "ask_faults": Out(1),
                "faults": In(state),
                "write": Out(1),
                "index": Out(range(ANSWER_MOST + 1)),
                "data": Out(8),
                "done": Out(1),
                "length": Out(range(ANSWER_MOST + 1)),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.writer = writer = ItemWriter(self._items)
        size = self._items.bytes
        payload = Signal.like(self.length)
        given = Signal(range(len(self._identity) + 1))
        faults = Signal(self._state)
        own = Signal()
        item = Signal(8 * size)
        heads = Signal()
        number = Signal(range(HEADER.size))
        header = Signal(8)
        identity = Array(Const(part, 8 * size) for part in self._identity)
        m.d.comb += [
            payload.eq(self.length - HEADER.size),
            item.eq(faults),
            writer.stream.valid.eq(self.stream.valid | own),
            writer.stream.item.eq(Mux(own, item, self.stream.item)),
            self.stream.ready.eq(writer.stream.ready),
            writer.begin.eq(self.begin),
            writer.at.eq(HEADER.size + size),
            header.eq(
                Array([self.type | ANSWER, self.seq, self.status, size, payload[:8], payload[8:]])[number],
            ),
            self.write.eq(writer.write | heads),
            self.index.eq(Mux(heads, number, writer.index)),
            self.data.eq(Mux(heads, header, writer.data)),
        ]
        with m.FSM() as machine:
            with m.State("idle"):
                with m.If(self.finish):
                    m.next = "faults"
                    with m.If(self.greeting):
                        m.next = "identity"
            with m.State("identity"):
                m.d.comb += [item.eq(identity[given]), own.eq(1)]
                with m.If(writer.stream.ready):
                    m.d.sync += given.eq(given + 1)
                    with m.If(given == len(self._identity) - 1):
                        m.next = "faults"
            with m.State("faults"):
                m.d.sync += given.eq(0)
                with m.If(writer.stream.ready):
                    m.d.comb += self.ask_faults.eq(1)
                    m.next = "faults_asked"
            with m.State("faults_asked"):
                m.d.comb += writer.at.eq(HEADER.size)
                with m.If(self.answered):
                    m.d.sync += [faults.eq(self.faults), self.length.eq(writer.index), number.eq(0)]
                    m.d.comb += writer.begin.eq(1)
                    m.next = "faults_item"
            with m.State("faults_item"):
                m.d.comb += own.eq(1)
                with m.If(writer.stream.ready):
                    m.next = "header"
            with m.State("header"):
                with m.If(writer.stream.ready):
                    m.d.comb += heads.eq(1)
                    m.d.sync += number.eq(number + 1)
                    with m.If(number == HEADER.size - 1):
                        m.d.comb += self.done.eq(1)
                        m.next = "idle"
        check_states(machine.encoding, WRITING, FINISH, HEAD)
        return m
