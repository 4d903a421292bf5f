"""The CRC of a frame, with the key in front of it."""

from amaranth.hdl import Array, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from .frame import ANSWER, CRC, GREETING, KEY_BYTES


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
        A byte is taken in a cycle in which both are 1: the first keeps the next waiting for `KEY_BYTES` cycles.
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
        first, keyed, number, waiting = Signal(init=1), Signal(), Signal(range(KEY_BYTES + 1)), Signal(8)
        key, taken, keying = Array(self._key), Signal(), number != 0
        m.d.comb += [
            self.ready.eq(~keying),
            taken.eq(self.valid & self.ready),
            keyed.eq(taken & first & ((self.data & ~ANSWER) != GREETING)),
            crc.start.eq(taken & first),
            crc.valid.eq(taken | keying),
            crc.data.eq(Mux(keyed, key[0], self.data)),
            self.crc.eq(crc.crc),
            self.match.eq(crc.match_detected),
        ]
        with m.If(taken):
            m.d.sync += [first.eq(0), waiting.eq(self.data), number.eq(keyed)]
        with m.If(keying):
            m.d.comb += crc.data.eq(Mux(number == KEY_BYTES, waiting, key[number[: (KEY_BYTES - 1).bit_length()]]))
            m.d.sync += number.eq(Mux(number == KEY_BYTES, 0, number + 1))
        with m.If(self.start):
            m.d.sync += first.eq(1)
        return m
