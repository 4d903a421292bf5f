"""From stored answers to the bytes of frames."""

from amaranth.hdl import Array, Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.link.crc import FrameCrc
from hw.link.frame import CRC_BYTES
from hw.link.interfaces import ByteStream

ANSWERS = 8
"""Answers that are kept: as many as commands may be under way."""

ANSWER_MOST = 512
"""Bytes of an answer, header and payload."""

BLOCK_MOST = 254
"""Bytes of a block of COBS without a zero."""

LOOK = READ_LATENCY + 2
"""Cycles from a byte to the next."""


class FrameSender(wiring.Component):
    """Keeps the last `ANSWERS` answers, and sends those that are asked for, each in a frame, in the order in which they
    were asked for.

    An answer's bytes are looked through three times: for the CRC, for the next zero, and when they are sent, a byte
    every `LOOK` cycles; so a gap on the line is at most `LOOK` times `BLOCK_MOST` cycles and a few, and that before a
    frame `LOOK` times `ANSWER_MOST`, a few and those of the key.

    Parameters
    ----------
    key : bytes

    Members
    -------
    write : In(1), write_answer : In, write_place : In, write_data : In(8)
        A byte of an answer: not while it waits.
    send : In(1), answer : In, length : In
        Send the answer, of so many bytes; without a length again, if it was sent before. One that waits is sent but
        once. The same answer not in two cycles behind one another.
    waits : Out(8)
        A bit for each answer: it is yet to be sent, or is being sent; from two cycles after ``send`` on.
    sent : Out(ByteStream)
        The line's bytes.
    """

    def __init__(self, key: bytes):
        self._key = key
        super().__init__(
            {
                "write": In(1),
                "write_answer": In(range(ANSWERS)),
                "write_place": In(range(ANSWER_MOST)),
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
        places = range(ANSWER_MOST + CRC_BYTES + 1)
        place, begin, end, whole = (Signal(places, name=name) for name in ("place", "begin", "end", "whole"))
        byte = Signal(8)
        here = Signal()
        wait = Signal(range(LOOK))
        m.d.comb += [
            answers.address.eq(Cat(place[: len(self.write_place)], answer)),
            crc.data.eq(byte),
            here.eq(wait == 0),  # the byte is that of the place, and all comparisons are of it
        ]
        with m.If(~here):
            m.d.sync += wait.eq(wait - 1)

        def look(at):
            return [place.eq(at), wait.eq(LOOK - 1)]

        in_answer = Signal()
        of_crc = Signal(range(CRC_BYTES))
        code = Signal(8)
        after_answer, after_all, at_end, full, last, was_full = (
            Signal(name=name) for name in ("after_answer", "after_all", "at_end", "full", "last", "was_full")
        )
        m.d.sync += [
            answers.write.eq(self.write),
            answers.write_address.eq(Cat(self.write_place, self.write_answer)),
            answers.write_data.eq(self.write_data),
            in_answer.eq(place < length),
            of_crc.eq(place - length),
            byte.eq(Mux(in_answer, answers.data, crc.crc.word_select(of_crc, 8))),
            whole.eq(length + CRC_BYTES),
            after_answer.eq(place == length),
            after_all.eq(place == whole),
            at_end.eq(place == end),
            full.eq(place - begin == BLOCK_MOST),
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
                with m.If(here & after_answer):
                    m.d.sync += look(0)
                    m.next = "front"
                with m.Elif(here & crc.ready):
                    m.d.comb += crc.valid.eq(1)
                    m.d.sync += look(place + 1)
            with m.State("front"):
                give(0, "block")
            with m.State("block"):  # where does it end?
                with m.If(here):
                    m.d.sync += look(place + 1)
                    with m.If(after_all | full | (byte == 0)):
                        m.d.sync += [end.eq(place), *look(begin)]
                        m.next = "code"
            with m.State("code"):
                with m.If(here):
                    give(code, "bytes")
            with m.State("bytes"):
                with m.If(here & ~at_end):
                    give(byte, "bytes")
                    with m.If(self.sent.ready):
                        m.d.sync += look(place + 1)
                with m.Elif(here):
                    m.next = "block"
                    with m.If(last):
                        m.next = "back"
                    with m.Elif(was_full):
                        m.d.sync += [begin.eq(end), *look(end)]
                    with m.Else():  # a zero, which the block stands for
                        m.d.sync += [begin.eq(end + 1), *look(end + 1)]
            with m.State("back"):
                give(0, "idle")
                m.d.comb += sent.eq(self.sent.ready)
        return m

    def _queue(self, m, sent):
        """The answer that is sent next, or just now, and its length: in registers, of which much depends. They have
        them one and two cycles after one of ``waits`` is set, or after ``next_out`` has moved on."""
        order = Array(Signal(range(ANSWERS), name=f"order_{n}") for n in range(ANSWERS))
        lengths = Array(Signal.like(self.length, name=f"length_{n}") for n in range(ANSWERS))
        next_in = Signal(range(ANSWERS))
        next_out = Signal(range(ANSWERS))
        answer = Signal.like(self.answer)
        length = Signal.like(self.length)
        m.d.sync += [answer.eq(order[next_out]), length.eq(lengths[answer])]
        asked = Signal()
        which = Signal.like(answer)
        its_length = Signal.like(length)
        m.d.sync += [
            asked.eq(self.send & ~self.waits.bit_select(self.answer, 1)),
            which.eq(self.answer),
            its_length.eq(Mux(self.length == 0, lengths[self.answer], self.length)),
        ]
        with m.If(asked & (its_length != 0)):
            m.d.sync += [lengths[which].eq(its_length), order[next_in].eq(which), next_in.eq(next_in + 1)]
            m.d.sync += self.waits.bit_select(which, 1).eq(1)
        with m.If(sent):
            m.d.sync += [next_out.eq(next_out + 1), self.waits.bit_select(answer, 1).eq(0)]
        return answer, length
