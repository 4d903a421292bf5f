"""Bounds on the time that commands take: from the end of a frame to the first byte of its answer, in clock cycles.

Each component states its own part, beside its state machine.
"""

from hw.link import answer, device, pause, receive, send, walk
from hw.link.frame import HEADER
from hw.link.items import Items
from hw.link.protocol import COUNT_MOST
from hw.link.work import Work

PAUSED = len(device.EXCHANGE) + pause.PAUSE_CYCLES + pause.RESUME_CYCLES
"""Cycles of a pause, besides the step that a run ends with."""


def cycles(work: Work, items: Items) -> int:
    """Return the cycles in which an ACCESS is answered at the latest, while no other answer is being sent.

    An EXCHANGE takes those of the pause as well: the run's step or two, and `PAUSED`.
    """
    return (
        receive.ARRIVAL
        + len(device.COMMAND)
        + walk.check_cycles(work, items)
        + walk.walk_cycles(work, items)
        + answer.finish_cycles(items)
        + send.start_cycles(HEADER.size + items.bytes * work.items)
    )


def one_word(items: Items) -> int:
    """Return the cycles of a command that reads a word."""
    return cycles(Work(segments=1, read=1), items)


def longest(items: Items) -> int:
    """Return the cycles of the longest command: heads alone, and as many of the longest checks as an answer holds."""
    checks = items.answer_most
    return cycles(Work(items.command_most, checked=checks * COUNT_MOST, checks=checks), items)
