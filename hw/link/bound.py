"""Bounds on the time that commands take: from the end of a frame to the first byte of its answer, in clock cycles."""

from dataclasses import dataclass

from hw.blocks.memory import READ_LATENCY
from hw.link.frame import HEADER, KEY_BYTES
from hw.link.items import Items
from hw.link.protocol import COUNT_MOST
from hw.link.send import LOOK
from hw.machine.host_port import LATENCY as HOST_LATENCY

# Cycles in the states of Device and Walker, one each where nothing else is said
PORT = 1 + HOST_LATENCY + 1  # a register on each way
TAKEN = 4 + 3  # the last byte through the receiver; idle, comparison, choice
LOOKED = 2 + 3  # a segment: between, segment; after its head's item: head, measure, room
WALKED = 2 + 2  # between, segment; after its head's item: head, the last words
THROUGH = 2 + 1 + 2  # between, segment; walk; between, segment
WORD = 2 + PORT  # words, access
SEALED = 1 + PORT + 1 + HEADER.size + 1  # faults and their item, header, send
SENT = 3 + KEY_BYTES + 1  # until the sender knows what is sent; the key, for its CRC

PAUSED = 3 * (PORT + 3) + 4
"""Cycles of a pause: STOP, STEPS_DONE and RUN."""


@dataclass(frozen=True)
class Work:
    """The work of an `hw.link.protocol.Operation.ACCESS`: its segments, the words that they read, write and check."""

    segments: int
    read: int = 0
    written: int = 0
    checked: int = 0
    checks: int = 0

    @property
    def items(self) -> int:
        """Items of its answer, with the faults."""
        return 1 + self.read + self.checks


def cycles(work: Work, items: Items) -> int:
    """Cycles in which an ACCESS is answered at the latest, while no other answer is being sent.

    An EXCHANGE takes those of the pause as well: the run's step or two, and `PAUSED`.
    """
    gathered = items.bytes * (READ_LATENCY + 1)  # an item from the payload
    return (
        TAKEN
        + work.segments * (LOOKED + WALKED + 2 * gathered)
        + THROUGH
        + work.read * (WORD + 1)
        + work.written * (WORD + gathered)
        + work.checked * (WORD + items.bytes)
        + work.checks
        + SEALED
        + 2 * items.bytes  # the last item and that of the faults are written
        + SENT
        + LOOK * (HEADER.size + items.bytes * work.items)
    )


def one_word(items: Items) -> int:
    """Cycles of a command that reads a word."""
    return cycles(Work(segments=1, read=1), items)


def longest(items: Items) -> int:
    """Cycles of the longest command: heads alone, and as many of the longest checks as an answer has room for."""
    checks = items.answer_most
    return cycles(Work(items.command_most, checked=checks * COUNT_MOST, checks=checks), items)
