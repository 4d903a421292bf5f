"""The interfaces between the components of the link. Each is seen from the side that gives most of it."""

from amaranth.lib.wiring import In, Out, Signature

EVENTS = "good_frames", "line_errors", "breaks", "cobs_errors", "length_errors", "crc_errors", "overruns"
"""The fates of a frame, and ``breaks``, which counts breaks on the line."""


class ReceivedBytes(Signature):
    """Bytes from a serial line.

    ``valid``: for one cycle, ``data`` is a byte that came. ``error``: for one cycle, a byte lacked its stop bit;
    ``broken`` with it: all of its bits were 0, a break.
    """

    def __init__(self):
        super().__init__({"valid": Out(1), "data": Out(8), "error": Out(1), "broken": Out(1)})


class ByteStream(Signature):
    """Bytes with a handshake: one is taken in each cycle in which ``valid`` and ``ready`` are both 1."""

    def __init__(self):
        super().__init__({"valid": Out(1), "data": Out(8), "ready": In(1)})


class ItemStream(Signature):
    """Items (`hw.link.items`) with the handshake of a `ByteStream`."""

    def __init__(self, bits: int):
        super().__init__({"valid": Out(1), "item": Out(bits), "ready": In(1)})


class FrameEvents(Signature):
    """A strobe for each of `EVENTS`, high for one cycle when it happens."""

    def __init__(self):
        super().__init__({event: Out(1) for event in EVENTS})
