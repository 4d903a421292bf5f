"""The CRC of a frame, with the key in front of it."""

from amaranth.hdl import Array, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.frame import ANSWER, CRC, GREETING, KEY_BYTES


class FrameCrc(wiring.Component):
    """Takes a frame's bytes from the type on; a greeting's without the key.

    Parameters
    ----------
    key : bytes
        `KEY_BYTES`.

    Members
    -------
    start : In(1)
        The next byte is a frame's first.
    valid : In(1), data : In(8), ready : Out(1)
        A byte is taken in a cycle in which both are 1, and keeps the next waiting for a cycle; a frame's first for
        `KEY_BYTES` more.
    crc : Out(32), match : Out(1)
        Of the bytes so far, when ``ready``; whether the last four of them are the CRC of those before.
    """

    def __init__(self, key: bytes):
        if len(key) != KEY_BYTES:
            raise ValueError(f"key must be {KEY_BYTES} bytes, not {len(key)}")
        self._key = key
        super().__init__(
            {
                "start": In(1),
                "valid": In(1),
                "data": In(8),
                "ready": Out(1),
                "crc": Out(32),
                "match": Out(1),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.crc = crc = CRC(data_width=8).create()
        first = Signal(init=1)
        begins = Signal()
        byte = Signal(8)
        waits = Signal()
        # the key goes before the byte that waits
        keyed = Signal()
        number = Signal(range(KEY_BYTES))
        m.d.comb += [
            self.ready.eq(~waits),
            crc.start.eq(waits & begins),
            crc.valid.eq(waits),
            crc.data.eq(Mux(keyed, Array(self._key)[number], byte)),
            self.crc.eq(crc.crc),
            self.match.eq(crc.match_detected),
        ]
        with m.If(waits):
            m.d.sync += [begins.eq(0), waits.eq(keyed), number.eq(0)]
            with m.If(keyed):
                m.d.sync += [number.eq(number + 1), keyed.eq(number != KEY_BYTES - 1)]
        with m.Elif(self.valid):
            m.d.sync += [byte.eq(self.data), waits.eq(1), begins.eq(first), first.eq(0)]
            m.d.sync += keyed.eq(first & ((self.data & ~ANSWER) != GREETING))
        with m.If(self.start):
            m.d.sync += first.eq(1)
        return m
