"""Tables of results: for a terminal, and in Markdown of what is published."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

from hw.boards import board as boards
from hw.boards.board import Board, Circuit
from hw.boards.result import Build, Result, Timing
from hw.sizes import SIZES, format_sizes, summary


def timing_report(timing: Timing, board: Board) -> str:
    """The text that a terminal shows of a timing result."""
    runs = ", ".join(f"{mhz:.1f}" for mhz in timing.fmax_mhz)
    limits = f"multiplier {timing.limits_mhz.multiplier:g} MHz, block RAM {timing.limits_mhz.block_ram:g} MHz"
    resources, frame = timing.resources, timing.frame
    lines = [
        f"{timing.board} ({board.device}, speed grade {timing.grade}): {summary(timing.circuit)}",
        "",
        f"Fmax    {timing.fmax_min:.1f} MHz at least, {timing.fmax_median:.1f} MHz median of {runs}",
        f"limits  {limits}: not timed by place and route",
        f"clock   {timing.clock_mhz:.1f} MHz",
        "",
        *_use(timing, board),
        f"{resources.lut_ram} LUT are memory; the frame for timing adds {frame.lut} LUT and {frame.ff} FF",
        "",
        f"critical path, {sum(step.ns for step in timing.critical_path):.2f} ns, of the run with the median",
        *(f"{step.ns:8.2f}  {step.name}" for step in timing.critical_path),
    ]
    return "\n".join(lines)


def build_report(build: Build, board: Board) -> str:
    """The text that a terminal shows of a build."""
    fmax = "".join(f", {mhz:.1f} MHz reached" for mhz in build.fmax_mhz)
    lines = [
        f"{build.board} ({board.device}): {summary(build.circuit)}",
        f"clock {build.clock_mhz:g} MHz{fmax}; line {build.baud} baud",
        *_use(build, board),
        build.state(board),
    ]
    return "\n".join(lines)


def _use(result: Result, board: Board) -> list[str]:
    uses = board.capacity.use(result.resources)
    return [f"{use.what:11}{use.used:8} of{use.available:8}{use.fraction:6.0%}" for use in uses]


class Row(NamedTuple):
    """A board in a table, with its result if one is published."""

    name: str
    board: Board
    result: Result | None

    @property
    def circuit(self) -> Circuit:
        return self.result.circuit if self.result else self.board.circuit

    def use(self, number: int) -> str:
        """Use of the resource of this number in `hw.families.resources.Capacity.use`; empty without a result."""
        if self.result is None:
            return ""
        use = self.board.capacity.use(self.result.resources)[number]
        return f"{use.used} ({use.fraction:.0%})"


Columns = Mapping[str, Callable[[Row], str]]

CIRCUIT: Columns = {
    size.name: lambda row, name=size.name: format_sizes(row.circuit)[name] for size in SIZES.values() if size.column
}
RESOURCES: Columns = {
    "LUT": lambda row: row.use(0),
    "FF": lambda row: row.use(1),
    "multipliers": lambda row: row.use(2),
    "block RAMs": lambda row: row.use(3),
}
TIMING: Columns = {
    "board": lambda row: row.name,
    **CIRCUIT,
    **RESOURCES,
    "Fmax, lowest": lambda row: f"{row.result.fmax_min:.1f} MHz" if row.result else "",
    "median": lambda row: f"{row.result.fmax_median:.1f} MHz" if row.result else "",
    "limit": lambda row: f"{row.result.limits_mhz.lowest:.1f} MHz" if row.result else "",
    "clock": lambda row: f"{row.result.clock_mhz:.1f} MHz" if row.result else "",
    "of version": lambda row: row.result.version if row.result else "not timed yet",
}
CLOCK: Columns = {"clock": lambda row: f"{row.result.clock_mhz if row.result else row.board.clock_mhz:g} MHz"}
STATE: Columns = {
    "published build": lambda row: row.result.state(row.board) if row.result else "none yet",
    "of version": lambda row: row.result.version if row.result else "",
}
BUILDS: Columns = {
    "board": lambda row: row.name,
    "device": lambda row: row.board.device,
    **CIRCUIT,
    **CLOCK,
    "Fmax": lambda row: ", ".join(f"{mhz:.1f} MHz" for mhz in row.result.fmax_mhz) if row.result else "",
    **RESOURCES,
    **STATE,
    "run on hardware": lambda row: "no",
}
SUMMARY: Columns = {
    "board": lambda row: row.name,
    "device": lambda row: row.board.device,
    **{name: cell for name, cell in CIRCUIT.items() if SIZES[name].brief},
    **CLOCK,
    **STATE,
}


def markdown(names: list[str], results: Mapping[str, Result], columns: Columns) -> str:
    """A row for each board, with its result if there is one."""
    rows = [Row(name, boards.load(name), results.get(name)) for name in names]
    lines = [list(columns), ["---"] * len(columns), *([cell(row) for cell in columns.values()] for row in rows)]
    head, rule, *body = (f"| {' | '.join(line)} |" for line in lines)
    return "\n".join([head, rule.replace(" ", ""), *body])
