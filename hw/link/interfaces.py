"""The interfaces between the components of the link. Each is seen from the side that gives most of it."""

from amaranth.lib.wiring import In, Out, Signature

EVENTS = "good_frames", "line_errors", "breaks", "cobs_errors", "length_errors", "crc_errors", "overruns"
"""The fates of the bytes between two zeros; and a break, which is none of them."""


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


class FrameEvents(Signature):
    """One of `EVENTS` happens, for one cycle."""

    def __init__(self):
        super().__init__({event: Out(1) for event in EVENTS})
