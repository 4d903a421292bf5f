"""What became of a board's bitstream: written beside it, kept below constraints/builds/ when it is to be published."""

from __future__ import annotations

from hw.boards import board as boards
from hw.boards.board import COLUMNS, Board, Circuit, cells_of, shares
from hw.sizes import summary

KEPT = boards.FOLDER / "builds"


class Build(Circuit, forbid_unknown_fields=True, kw_only=True):
    board: str
    clock_mhz: float  # what the PLL gives
    baud: int
    lut: int
    ff: int
    multipliers: int
    block_rams: int
    lut_ram: int  # of lut
    over: str  # what doesn't fit, or nothing
    fmax_mhz: float | None  # of nextpnr; None if it has not been placed
    tools: dict[str, str]
    verilog_sha256: str
    bitstream_sha256: str | None  # None if there is none

    def missed(self) -> str:
        """By how much the clock is missed, or nothing."""
        if self.fmax_mhz is None or self.fmax_mhz >= self.clock_mhz:
            return ""
        late = 1000 / self.fmax_mhz - 1000 / self.clock_mhz
        return (
            f"the clock of {self.board} must be at most {self.fmax_mhz:.1f} MHz, not {self.clock_mhz:g} MHz: its "
            f"longest path is {late:.2f} ns too long"
        )

    def state(self, board: Board) -> str:
        """What may be said of it."""
        if self.over:
            return f"does not fit: {self.over}"
        if self.fmax_mhz is None:
            return "project for Vivado, synthesised by Yosys"
        if self.bitstream_sha256 is None or self.missed():
            return "placed, misses its clock"
        return "built and timed" if board.family in boards.TIMED else "built, multipliers and block RAMs not timed"


def table(build: Build, board: Board) -> str:
    """What a terminal shows of a build."""
    fmax = "" if build.fmax_mhz is None else f", {build.fmax_mhz:.1f} MHz reached"
    lines = [
        f"{build.board} ({board.device}): {summary(build)}",
        f"clock {build.clock_mhz:g} MHz{fmax}; line {build.baud} baud",
        *(f"{name:11}{used:8} of{of:8}{used / of:6.0%}" for name, used, of in shares(build, board)),
        build.state(board),
    ]
    return "\n".join(lines)


HEAD = f"| board | device | {COLUMNS} | clock | Fmax | LUT | FF | multipliers | block RAMs | state | run on hardware |"


def published(kept: dict[str, Build]) -> str:
    """Markdown: every board with what is kept of it."""
    lines = [HEAD, "|---" * (HEAD.count("|") - 1) + "|"]
    for name in boards.names():
        board = boards.load(name)
        lines.append(f"| {' | '.join([name, board.device, *_cells(kept.get(name), board)])} |")
    return "\n".join(lines)


def _cells(build: Build | None, board: Board) -> list[str]:
    if build is None:
        return [*cells_of(board.circuit), f"{board.clock_mhz:g} MHz", *[""] * 5, "not built yet", "no"]
    return [
        *cells_of(build),
        f"{build.clock_mhz:g} MHz",
        "" if build.fmax_mhz is None else f"{build.fmax_mhz:.1f} MHz",
        *(f"{used} ({used / of:.0%})" for _, used, of in shares(build, board)),
        build.state(board),
        "no",
    ]
