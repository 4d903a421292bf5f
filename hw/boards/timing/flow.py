"""From a board to its figures: Verilog, synthesis, place and route with each seed."""

import hashlib
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from statistics import median

from hw.boards.board import Board, fits
from hw.boards.timing import report, tools
from hw.boards.timing.frame import framed
from hw.boards.timing.result import Result, Smallest
from hw.parameters import Parameters
from hw.sizes import sizes_of

SMALLEST = Parameters(lanes=1, nodes=16, edges=16, materials=2, tables=1, family="ecp5")


def measure(
    name: str,
    board: Board,
    parameters: Parameters,
    seeds: list[int],
    folder: Path,
    shown: Callable[[str], None],
    jobs: int = 1,
) -> Result:
    """Everything a `Result` holds; ``shown`` is told what is being done, ``jobs`` seeds at a time.

    Raises
    ------
    InputError
        If the circuit is too large for the board.
    """
    shown("synthesis")
    verilog = framed(parameters)
    synthesised, frame = report.sizes(tools.synthesise(verilog, folder, name, board))
    fits(name, synthesised, board)

    def placed(seed: int) -> dict:
        shown(f"seed {seed}")
        return tools.place_and_route(board, folder, name, seed)

    with ThreadPoolExecutor(jobs) as pool:
        reports = list(pool.map(placed, seeds))
    clocks = [report.fmax(found) for found in reports]
    middle = sorted(clocks)[(len(clocks) - 1) // 2]
    limits, sizes = board.limits_mhz, report.placed(reports[0]) - frame
    return Result(
        board=name,
        **sizes_of(parameters),
        grade=board.grade,
        seeds=seeds,
        fmax_mhz=clocks,
        fmax_min=min(clocks),
        fmax_median=round(median(clocks), 2),
        limits_mhz=limits,
        clock_mhz=min(round(median(clocks), 2), limits.multiplier, limits.block_ram),
        **{size: getattr(sizes, size) for size in sizes.__struct_fields__},
        frame=frame,
        critical_path=report.critical_path(reports[clocks.index(middle)]),
        tools=tools.versions(),
        sha256=hashlib.sha256(verilog.encode()).hexdigest(),
    )


def smallest(folder: Path) -> Smallest:
    """What the smallest circuit takes."""
    circuit, _ = report.sizes(tools.synthesise(framed(SMALLEST), folder, "smallest"))
    return Smallest(sizes_of(SMALLEST), circuit)
