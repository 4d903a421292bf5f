"""What each operation of the datapath costs in registers, per device family, in one place."""

from dataclasses import dataclass

from .blocks.memory import READ_LATENCY


@dataclass(frozen=True)
class Cost:
    """Registers behind each kind of operation of `golden.graph` (0: it shares the next operation's cycle).

    An operation in several steps (`hw.operations`) gets its registers behind its last steps; those that it has more
    than steps follow as a delay.

    Raises
    ------
    ValueError
        If a multiplier has fewer than 2.
    """

    add: int = 1
    sub: int = 1
    mul: int = 3
    abs: int = 1
    less: int = 1
    select: int = 0
    lead: int = 2
    shift_left: int = 1
    round: int = 1
    shift_right: int = 3
    read: int = READ_LATENCY

    def __post_init__(self):
        if self.mul < 2:
            raise ValueError(f"mul must be at least 2 registers, not {self.mul!r}")


FAMILIES = {"generic": Cost()}
