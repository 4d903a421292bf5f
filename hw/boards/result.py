"""Results of the flow: timing of a circuit alone, and a board's bitstream."""

from __future__ import annotations

from pathlib import Path
from typing import ClassVar, TypeVar

import msgspec
from msgspec import Struct

from golden.support.files import write_text
from hw.boards import board as boards
from hw.boards.board import Board, Circuit
from hw.boards.report import Step
from hw.families.family import Limits
from hw.families.registry import get_family
from hw.families.resources import Resources


class Smallest(Struct, forbid_unknown_fields=True, kw_only=True):
    """The resources of a circuit on a board's device after synthesis. Those of the smallest circuit show a change of
    size without place and route."""

    version: str  # of this project
    board: str
    circuit: Circuit
    resources: Resources


class Result(Smallest, forbid_unknown_fields=True, kw_only=True):
    """The part that timing and bitstream share."""

    PUBLISHED: ClassVar[Path]
    """The folder of the results that are published, a file for each board."""

    seeds: list[int]
    fmax_mhz: list[float]  # with each seed; empty without place and route
    clock_mhz: float
    tools: dict[str, str]  # versions
    verilog_sha256: str


class Timing(Result, forbid_unknown_fields=True, kw_only=True):
    """Timing of the circuit alone, in its frame (`hw.boards.frame`). ``clock_mhz`` is the lower of the median and the
    limits; ``resources`` are those after place and route, without the frame."""

    PUBLISHED: ClassVar[Path] = boards.FOLDER / "timing"

    grade: int
    fmax_min: float
    fmax_median: float
    limits_mhz: Limits
    frame: Resources
    critical_path: list[Step]  # of the run with the median


class Build(Result, forbid_unknown_fields=True, kw_only=True):
    """A board's bitstream. ``clock_mhz`` is that of the PLL; ``resources`` are those after synthesis."""

    PUBLISHED: ClassVar[Path] = boards.FOLDER / "builds"

    baud: int
    exceeded: str  # resources of which the device has too few, or empty
    bitstream_sha256: str | None  # None without a bitstream

    def missed(self) -> str:
        """The message for a clock that is missed; empty if it is met or not timed."""
        if not self.fmax_mhz or (fmax := min(self.fmax_mhz)) >= self.clock_mhz:
            return ""
        late = 1000 / fmax - 1000 / self.clock_mhz
        return (
            f"the clock of {self.board} must be at most {fmax:.1f} MHz, not {self.clock_mhz:g} MHz: its "
            f"longest path is {late:.2f} ns too long"
        )

    def state(self, board: Board) -> str:
        """How far the build got, and how much of it is timed."""
        family = get_family(board.family)
        if self.exceeded:
            return f"does not fit: {self.exceeded}"
        if not self.fmax_mhz:
            return f"project for {family.flow.vendor}, synthesised by Yosys"
        if self.bitstream_sha256 is None or self.missed():
            return "placed, misses its clock"
        return "built and timed" if family.timed else "built, multipliers and block RAMs not timed"


Kind = TypeVar("Kind", bound=Smallest)


def write(path: Path, result: Smallest) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, msgspec.json.format(msgspec.json.encode(result), indent=2).decode() + "\n")


def read(path: Path, kind: type[Kind]) -> Kind:
    return msgspec.json.decode(path.read_bytes(), type=kind)


def published(kind: type[Kind], folder: Path | None = None) -> dict[str, Kind]:
    """The published results of a kind, by board."""
    paths = {name: (folder or kind.PUBLISHED) / f"{name}.json" for name in boards.names()}
    return {name: read(path, kind) for name, path in paths.items() if path.exists()}
