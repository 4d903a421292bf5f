"""Receive frames: store their payloads whole, and offer those that came without damage."""

from amaranth.hdl import Array, Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import BlockRam
from hw.link.crc import FrameCrc
from hw.link.frame import HEADER, KEY_BYTES, LEAST, MOST, PAYLOAD_MOST
from hw.link.interfaces import FrameEvents, ReceivedBytes
from hw.machine.interfaces import named

SLOTS = 4
"""Frames that there is room for: one being received, those that wait, one being worked on."""

BYTE_CYCLES = KEY_BYTES + 6
"""Fewest cycles from a byte to the next: the CRC first takes the key, and each comparison has its own cycle."""

ARRIVAL = len(("byte", "event", "waiting", "frame"))
"""Cycles from the byte that ends a frame to ``frame``: the registers between them."""


class FrameReceiver(wiring.Component):
    """Take a frame's bytes as they come, and offer whole frames in order.

    A zero byte or a break ends a frame; two of them in a row are neither a frame nor an error. A frame is dropped, and
    counted as the first of these that applies: a byte lacked its stop bit or a break came (``line_errors``), it isn't
    COBS (``cobs_errors``), is not as long as it says (``length_errors``), has a wrong CRC (``crc_errors``), there is no
    room for it (``overruns``).

    Parameters
    ----------
    key : bytes

    Members
    -------
    received : In(ReceivedBytes)
        At most a byte every `BYTE_CYCLES`.
    frame : Out(1), type : Out(8), seq : Out(8), length : Out
        A frame waits, and its header.
    index : In, byte : Out(8)
        A byte of its payload, `hw.blocks.memory.READ_LATENCY` cycles after its index.
    take : In(1)
        The frame is done. Only while ``frame``; the next one is offered two cycles later.
    events : Out(FrameEvents)
        In the second cycle after the byte or the break.
    """

    def __init__(self, key: bytes):
        self._key = key
        super().__init__(
            {
                "received": In(ReceivedBytes()),
                "frame": Out(1),
                "type": Out(8),
                "seq": Out(8),
                "length": Out(range(PAYLOAD_MOST + 1)),
                "index": In(range(PAYLOAD_MOST)),
                "byte": Out(8),
                "take": In(1),
                "events": Out(FrameEvents()),
            }
        )

    def elaborate(self, platform):
        m = Module()
        valid = Signal()
        data = Signal(8)
        error = Signal()
        broken = Signal()
        ends = Signal()
        m.d.sync += [
            valid.eq(self.received.valid),
            data.eq(self.received.data),
            error.eq(self.received.error),
            broken.eq(self.received.broken),
            ends.eq(self.received.valid & (self.received.data == 0) | self.received.broken),
        ]
        decoded, byte, open_block = self._decode(m, valid, data, ends)
        count = Signal(range(MOST + 2))  # decoded bytes; saturates one above the longest frame
        with m.If(decoded & (count <= MOST)):
            m.d.sync += count.eq(count + 1)
        header = self._header(m, decoded, byte, count)
        length = Cat(header[4], header[5])
        crc_match = self._crc(m, decoded, byte, ends)
        room = self._store(m, decoded, byte, count, header)

        some, bad_line, bad_cobs, bad_length, bad_crc, lost = (
            Signal(name=name) for name in ("some", "bad_line", "bad_cobs", "bad_length", "bad_crc", "lost")
        )
        m.d.sync += [
            bad_cobs.eq(open_block),
            bad_length.eq((count < LEAST) | (count != length + LEAST)),
            bad_crc.eq(~crc_match),
        ]
        with m.If(ends):
            m.d.sync += [count.eq(0), some.eq(0), bad_line.eq(0), lost.eq(0)]
        with m.Else():
            m.d.sync += lost.eq(lost | decoded & ~room)
            with m.If(valid | error):
                m.d.sync += [some.eq(1), bad_line.eq(bad_line | error)]
        verdicts = (
            ("line_errors", bad_line | broken),
            ("cobs_errors", bad_cobs),
            ("length_errors", bad_length),
            ("crc_errors", bad_crc),
            ("overruns", lost),
        )
        events = named(self.events)
        m.d.sync += [*(event.eq(0) for event in events.values()), self.events.breaks.eq(broken)]
        with m.If(ends & some):
            with m.If(verdicts[0][1]):
                m.d.sync += self.events.line_errors.eq(1)
            for event, applies in verdicts[1:]:
                with m.Elif(applies):
                    m.d.sync += events[event].eq(1)
            with m.Else():
                m.d.sync += self.events.good_frames.eq(1)
        return m

    def _decode(self, m, valid, data, ends):
        """Return (a byte is decoded, the byte, its COBS block goes on), a cycle after the line's byte."""
        left = Signal(8)  # bytes that are left of the block
        full = Signal()  # no zero follows the block
        begun = Signal()  # this isn't the frame's first block
        decoded = Signal()
        byte = Signal(8)
        m.d.sync += decoded.eq(0)
        with m.If(ends):
            m.d.sync += [left.eq(0), begun.eq(0)]
        with m.Elif(valid):
            with m.If(left == 0):
                m.d.sync += [left.eq(data - 1), full.eq(data == 0xFF), begun.eq(1)]
                m.d.sync += [decoded.eq(begun & ~full), byte.eq(0)]
            with m.Else():
                m.d.sync += [left.eq(left - 1), decoded.eq(1), byte.eq(data)]
        return decoded, byte, left != 0

    def _header(self, m, decoded, byte, count):
        header = [Signal(8, name=f"header_{n}") for n in range(HEADER.size)]
        for n, register in enumerate(header):
            with m.If(decoded & (count == n)):
                m.d.sync += register.eq(byte)
        return header

    def _crc(self, m, decoded, byte, ends):
        m.submodules.crc = crc = FrameCrc(self._key)
        m.d.comb += [crc.valid.eq(decoded), crc.data.eq(byte), crc.start.eq(ends)]
        return crc.match

    def _store(self, m, decoded, byte, count, header):
        """Keep payloads in a memory and headers in registers. Return whether there is room for a byte."""
        m.submodules.payloads = payloads = BlockRam(width=8, depth=SLOTS * PAYLOAD_MOST)
        coming = Signal(range(SLOTS))
        worked = Signal(range(SLOTS))
        waiting = Signal(range(SLOTS + 1))
        room = Signal()
        index = Signal(range(MOST + 2))
        kept = [Signal(24 + 8, name=f"kept_{slot}") for slot in range(SLOTS)]
        first = Array(kept)[worked]
        m.d.comb += [
            index.eq(count - HEADER.size),
            payloads.address.eq(Cat(self.index, worked)),
            self.byte.eq(payloads.data),
        ]
        m.d.sync += [
            room.eq(waiting != SLOTS),
            payloads.write.eq(decoded & (count >= HEADER.size) & (index < PAYLOAD_MOST) & room),
            payloads.write_address.eq(Cat(index[: len(self.index)], coming)),
            payloads.write_data.eq(byte),
        ]
        with m.If(self.events.good_frames):
            m.d.sync += [Array(kept)[coming].eq(Cat(header[0], header[1], header[4], header[5])), coming.eq(coming + 1)]
        m.d.sync += [waiting.eq(waiting + self.events.good_frames - self.take), worked.eq(worked + self.take)]
        with m.If(self.take):
            m.d.sync += self.frame.eq(0)
        with m.Elif(~self.frame & (waiting != 0)):
            m.d.sync += [self.frame.eq(1), Cat(self.type, self.seq, self.length).eq(first)]
        return room
