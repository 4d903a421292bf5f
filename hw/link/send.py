"""Keep answers, and send them as frames."""

from amaranth.hdl import Array, Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.link.crc import FIRST_BYTE, FrameCrc
from hw.link.frame import CRC_BYTES
from hw.link.interfaces import ByteStream

ANSWERS = 8
"""Answers that are kept, which is also how many commands may be under way."""

ANSWER_MOST = 512
"""Bytes of an answer, header and payload."""

BLOCK_MOST = 254
"""Most bytes of a COBS block, its code not counted."""

LOOK = READ_LATENCY + 2
"""Cycles from a byte to the next: its index, the memory, a register, the comparisons."""

QUEUE = len(("request", "waits"))
"""Cycles from ``send`` to the state machine: the registers between them."""


def start_cycles(length: int) -> int:
    """Return the cycles from ``send`` to a frame's first byte, for an answer of ``length`` bytes. The CRC is first."""
    return QUEUE + LOOK + FIRST_BYTE + (length - 1) * LOOK


class FrameSender(wiring.Component):
    """Keep the last `ANSWERS` answers, and send each on request, in a frame, in the order of the requests.

    An answer's bytes are read three times, a byte every `LOOK` cycles: for the CRC, to find the next zero, and to send
    them. So a gap within a frame is at most `LOOK` times `BLOCK_MOST` cycles and a few, and the gap before a frame at
    most `start_cycles` of `ANSWER_MOST` bytes.

    Parameters
    ----------
    key : bytes

    Members
    -------
    write : In(1), write_answer : In, write_index : In, write_data : In(8)
        A byte of an answer that does not wait.
    send : In(1), answer : In, length : In
        Send the answer, of so many bytes. Length 0 sends it again, if it was sent before. An answer that waits is sent
        only once. Not the same answer in two successive cycles.
    waits : Out(8)
        A bit for each answer that is still to be sent or is being sent; from two cycles after ``send`` on.
    sent : Out(ByteStream)
        The line's bytes.
    """

    def __init__(self, key: bytes):
        self._key = key
        super().__init__(
            {
                "write": In(1),
                "write_answer": In(range(ANSWERS)),
                "write_index": In(range(ANSWER_MOST)),
                "write_data": In(8),
                "send": In(1),
                "answer": In(range(ANSWERS)),
                "length": In(range(ANSWER_MOST + 1)),
                "waits": Out(ANSWERS),
                "sent": Out(ByteStream()),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.answers = answers = BlockRam(width=8, depth=ANSWERS * ANSWER_MOST)
        m.submodules.crc = crc = FrameCrc(self._key)
        sent = Signal()
        answer, length = self._queue(m, sent)
        indices = range(ANSWER_MOST + CRC_BYTES + 1)
        index, begin, end, whole = (Signal(indices, name=name) for name in ("index", "begin", "end", "whole"))
        byte = Signal(8)
        settled = Signal()  # the byte is that of the index, and all comparisons are up to date
        wait = Signal(range(LOOK))
        m.d.comb += [
            answers.address.eq(Cat(index[: len(self.write_index)], answer)),
            crc.data.eq(byte),
            settled.eq(wait == 0),
        ]
        with m.If(~settled):
            m.d.sync += wait.eq(wait - 1)

        def look(at):
            return [index.eq(at), wait.eq(LOOK - 1)]

        in_answer = Signal()
        of_crc = Signal(range(CRC_BYTES))
        code = Signal(8)
        after_answer, after_all, at_end, full, last, was_full = (
            Signal(name=name) for name in ("after_answer", "after_all", "at_end", "full", "last", "was_full")
        )
        m.d.sync += [
            answers.write.eq(self.write),
            answers.write_address.eq(Cat(self.write_index, self.write_answer)),
            answers.write_data.eq(self.write_data),
            in_answer.eq(index < length),
            of_crc.eq(index - length),
            byte.eq(Mux(in_answer, answers.data, crc.crc.word_select(of_crc, 8))),
            whole.eq(length + CRC_BYTES),
            after_answer.eq(index == length),
            after_all.eq(index == whole),
            at_end.eq(index == end),
            full.eq(index - begin == BLOCK_MOST),
            last.eq(end == whole),
            was_full.eq(end - begin == BLOCK_MOST),
            code.eq(end - begin + 1),
        ]

        def give(value, following):
            m.d.comb += [self.sent.valid.eq(1), self.sent.data.eq(value)]
            with m.If(self.sent.ready):
                m.next = following

        with m.FSM():
            with m.State("idle"):
                m.d.comb += crc.start.eq(1)
                m.d.sync += [*look(0), begin.eq(0)]
                with m.If(self.waits.any()):
                    m.next = "crc"
            with m.State("crc"):
                with m.If(settled & after_answer):
                    m.d.sync += look(0)
                    m.next = "front"
                with m.Elif(settled & crc.ready):
                    m.d.comb += crc.valid.eq(1)
                    m.d.sync += look(index + 1)
            with m.State("front"):
                give(0, "block")
            with m.State("block"):  # find its end
                with m.If(settled):
                    m.d.sync += look(index + 1)
                    with m.If(after_all | full | (byte == 0)):
                        m.d.sync += [end.eq(index), *look(begin)]
                        m.next = "code"
            with m.State("code"):
                with m.If(settled):
                    give(code, "bytes")
            with m.State("bytes"):
                with m.If(settled & ~at_end):
                    give(byte, "bytes")
                    with m.If(self.sent.ready):
                        m.d.sync += look(index + 1)
                with m.Elif(settled):
                    m.next = "block"
                    with m.If(last):
                        m.next = "back"
                    with m.Elif(was_full):
                        m.d.sync += [begin.eq(end), *look(end)]
                    with m.Else():  # the block stands for the zero as well
                        m.d.sync += [begin.eq(end + 1), *look(end + 1)]
            with m.State("back"):
                give(0, "idle")
                m.d.comb += sent.eq(self.sent.ready)
        return m

    def _queue(self, m, sent):
        """Return the answer that is being sent or is next, and its length, in registers.

        They follow one and two cycles after a bit of ``waits`` is set or ``next_out`` changes.
        """
        order = Array(Signal(range(ANSWERS), name=f"order_{n}") for n in range(ANSWERS))
        lengths = Array(Signal.like(self.length, name=f"length_{n}") for n in range(ANSWERS))
        next_in = Signal(range(ANSWERS))
        next_out = Signal(range(ANSWERS))
        answer = Signal.like(self.answer)
        length = Signal.like(self.length)
        m.d.sync += [answer.eq(order[next_out]), length.eq(lengths[answer])]
        requested = Signal()
        which = Signal.like(answer)
        its_length = Signal.like(length)
        m.d.sync += [
            requested.eq(self.send & ~self.waits.bit_select(self.answer, 1)),
            which.eq(self.answer),
            its_length.eq(Mux(self.length == 0, lengths[self.answer], self.length)),
        ]
        with m.If(requested & (its_length != 0)):
            m.d.sync += [lengths[which].eq(its_length), order[next_in].eq(which), next_in.eq(next_in + 1)]
            m.d.sync += self.waits.bit_select(which, 1).eq(1)
        with m.If(sent):
            m.d.sync += [next_out.eq(next_out + 1), self.waits.bit_select(answer, 1).eq(0)]
        return answer, length
