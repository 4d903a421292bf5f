"""The work of a command, in the numbers that its time depends on."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Work:
    """The work of an `hw.link.protocol.Operation.ACCESS`.

    Attributes
    ----------
    segments : int
    read, written, checked : int
        Words, in all segments.
    checks : int
        Segments that check words.
    """

    segments: int
    read: int = 0
    written: int = 0
    checked: int = 0
    checks: int = 0

    @property
    def items(self) -> int:
        """Items of its answer, with the faults."""
        return 1 + self.read + self.checks
