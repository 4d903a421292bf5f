"""The view of a board that a family's tools need."""

from collections.abc import Mapping
from typing import Protocol

from msgspec import Struct

from golden.scene.schema import Count


class Pin(Struct, forbid_unknown_fields=True):
    """The device's pin that a port of the board's top is connected to, and its electrical standard."""

    pin: str
    io: str  # standard, as the family's tools call it
    pull: str = "none"
    drive: Count | None = None  # mA
    active_low: bool = False  # for a button or a light


class Target(Protocol):
    """A device on a board: `hw.boards.board.Board` is one."""

    device: str
    package: str
    grade: int  # speed grade
    oscillator_mhz: float
    clock_mhz: float
    no_wide_luts: bool
    """Avoid lookup tables of five inputs or more: they are made of several that must be adjacent, and a device that is
    nearly full has too few adjacent sites left."""

    @property
    def ports(self) -> Mapping[str, Pin]:
        """The connected pins by port of the board's top."""
        ...
