"""How long commands take: from the end of a frame to the first byte of its answer, in clock cycles."""

from dataclasses import dataclass

from hw.blocks.memory import READ_LATENCY
from hw.link.frame import HEADER, KEY_BYTES, PAYLOAD_MOST
from hw.link.protocol import COUNT_MOST, ITEM_BYTES, ITEMS_MOST
from hw.link.send import LOOK
from hw.machine.host_port import LATENCY as HOST_LATENCY

# What each takes of the states of Device, Walker and Emitter, all of which last a cycle, but for those named
ITEM = ITEM_BYTES * (READ_LATENCY + 1)  # gathered from the payload
PORT = 1 + HOST_LATENCY + 1  # a register on each way
TAKEN = 4 + 3  # the last byte through the receiver; idle, comparison, choice
LOOKED = 2 + ITEM + 3  # a segment: between, segment, its head's item; head, measure, room
WALKED = 2 + ITEM + 2  # between, segment, its head's item; head, the last words
THROUGH = 2 + 1 + 2  # between, segment; walk; between, segment
WORD = 2 + PORT  # words, access
SEALED = ITEM_BYTES + 1 + PORT + 1 + ITEM_BYTES + HEADER.size + 1  # the last item, faults and their item, header, send
SENT = 3 + KEY_BYTES + 1  # until the sender knows what is sent; the key, for its CRC


@dataclass(frozen=True)
class Work:
    """What an `hw.link.protocol.Operation.ACCESS` holds: segments, and words that are read, written and checked."""

    segments: int
    read: int = 0
    written: int = 0
    checked: int = 0
    checks: int = 0

    @property
    def items(self) -> int:
        """Of its answer, the faults among them."""
        return 1 + self.read + self.checks


def cycles(work: Work) -> int:
    """Cycles in which an ACCESS is answered at the latest, while no other answer is being sent. An EXCHANGE takes those
    of the pause as well: the run's step or two, and `PAUSED`."""
    return (
        TAKEN
        + work.segments * (LOOKED + WALKED)
        + THROUGH
        + work.read * (WORD + 1)
        + work.written * (WORD + ITEM)
        + work.checked * (WORD + ITEM_BYTES)
        + work.checks
        + SEALED
        + SENT
        + LOOK * (HEADER.size + ITEM_BYTES * work.items)
    )


PAUSED = 3 * (PORT + 3) + 4
"""Of a pause: STOP, STEPS_DONE and RUN."""

ONE_WORD = cycles(Work(segments=1, read=1))
LONGEST = cycles(Work(PAYLOAD_MOST // ITEM_BYTES, checked=ITEMS_MOST * COUNT_MOST, checks=ITEMS_MOST))
"""That of a payload full of heads: as many of the longest checks as an answer can hold the sums of."""
