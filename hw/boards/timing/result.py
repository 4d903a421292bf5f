"""The figures of one board: written below build/, kept below constraints/timing/ when they are to be published."""

from __future__ import annotations

from pathlib import Path

import msgspec
from msgspec import Struct

from golden.support.files import write_text
from hw.boards import board as boards
from hw.boards.board import COLUMNS, Board, Circuit, Limits, cells_of, shares
from hw.boards.timing.report import Step
from hw.families.cells import Sizes
from hw.sizes import summary

KEPT = boards.FOLDER / "timing"


class Result(Circuit, forbid_unknown_fields=True, kw_only=True):
    board: str
    grade: int
    seeds: list[int]
    fmax_mhz: list[float]
    fmax_min: float
    fmax_median: float
    limits_mhz: Limits
    clock_mhz: float  # the lower of the median and the limits
    lut: int
    ff: int
    multipliers: int
    block_rams: int
    lut_ram: int  # of lut
    frame: Sizes  # what surrounds the circuit for timing; counted nowhere else
    critical_path: list[Step]  # of the run with the median
    tools: dict[str, str]
    sha256: str  # of the circuit's Verilog in its frame


class Smallest(Struct, forbid_unknown_fields=True):
    """What the smallest circuit takes after synthesis: a change of size shows without place and route."""

    circuit: dict[str, int]
    sizes: Sizes


def write(path: Path, result: Struct) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, msgspec.json.format(msgspec.json.encode(result), indent=2).decode() + "\n")


def read(path: Path, kind: type):
    return msgspec.json.decode(path.read_bytes(), type=kind)


def table(result: Result, board: Board) -> str:
    """What a terminal shows of a result."""
    runs = ", ".join(f"{mhz:.1f}" for mhz in result.fmax_mhz)
    limits = f"multiplier {result.limits_mhz.multiplier:g} MHz, block RAM {result.limits_mhz.block_ram:g} MHz"
    lines = [
        f"{result.board} ({board.device}, speed grade {result.grade}): {summary(result)}",
        "",
        f"Fmax    {result.fmax_min:.1f} MHz at least, {result.fmax_median:.1f} MHz median of {runs}",
        f"limits  {limits}: not seen by place and route",
        f"clock   {result.clock_mhz:.1f} MHz",
        "",
        f"{'':11}{'takes':>8}{'of':>8}",
        *(f"{name:11}{used:8}{available:8}{used / available:6.0%}" for name, used, available in shares(result, board)),
        f"{result.lut_ram} LUT are memory; the frame for timing adds {result.frame.lut} LUT and {result.frame.ff} FF",
        "",
        f"critical path, {sum(step.ns for step in result.critical_path):.2f} ns, of the run with the median",
        *(f"{step.ns:8.2f}  {step.name}" for step in result.critical_path),
    ]
    return "\n".join(lines)


HEAD = f"| board | {COLUMNS} | LUT | FF | multipliers | block RAMs | Fmax, lowest | median | limit | clock |"


def published(folder: Path = KEPT) -> str:
    """Markdown: every board whose device the tools time, with what is kept of it."""
    columns = HEAD.count("|") - 1
    lines = [HEAD, "|---" * columns + "|"]
    for name in boards.timed():
        path = folder / f"{name}.json"
        cells = [name, *(_cells(read(path, Result), boards.load(name)) if path.exists() else ["not timed yet"])]
        lines.append(f"| {' | '.join(cells + [''] * (columns - len(cells)))} |")
    return "\n".join(lines)


def _cells(result: Result, board: Board) -> list[str]:
    limit = min(result.limits_mhz.multiplier, result.limits_mhz.block_ram)
    clocks = result.fmax_min, result.fmax_median, limit, result.clock_mhz
    return [
        *cells_of(result),
        *(f"{used} ({used / available:.0%})" for _, used, available in shares(result, board)),
        *(f"{mhz:.1f} MHz" for mhz in clocks),
    ]
