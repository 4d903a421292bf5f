"""The CRC of a frame, over the key and its bytes."""

from amaranth.hdl import Array, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.frame import ANSWER, CRC, GREETING, KEY_BYTES

BYTE = len(("taken", "summed"))
"""Cycles from a byte to the next."""

FIRST_BYTE = KEY_BYTES + BYTE
"""Cycles from a frame's first byte to the next; the key is summed before it."""


class FrameCrc(wiring.Component):
    """Compute the CRC of a frame's bytes from the type on, after the key. A greeting has no key.

    Parameters
    ----------
    key : bytes
        `KEY_BYTES`.

    Members
    -------
    start : In(1)
        The next byte is a frame's first.
    valid : In(1), data : In(8), ready : Out(1)
        A byte is taken in a cycle in which both are 1; the next one `BYTE` cycles later, after a frame's first byte
        `FIRST_BYTE` cycles.
    crc : Out(32), match : Out(1)
        While ``ready``: the CRC of the bytes so far; their last four are the CRC of those before.
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
        begins = Signal()  # the waiting byte is a frame's first
        byte = Signal(8)
        waits = Signal()
        keyed = Signal()  # the key goes before the waiting byte
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
