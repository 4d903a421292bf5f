"""The flow from parameters to a result: clock and size of the circuit alone, or the bitstream of a board's top."""

import hashlib
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from statistics import median

from golden.support.errors import InputError
from hw.boards import report
from hw.boards.board import Board, Circuit
from hw.boards.frame import FRAME, framed
from hw.boards.project import version
from hw.boards.result import Build, Smallest, Timing
from hw.boards.tools import Tools, cell_counts
from hw.boards.top import BOARD, board_top
from hw.families.flow import Flow
from hw.families.registry import get_family
from hw.families.resources import Resources
from hw.parameters import Parameters
from hw.sizes import SIZES, sizes_of

SMALLEST = {size.name: size.small for size in SIZES.values()}
"""Sizes of a small circuit whose resources are published."""
NAME = "rheogate"
"""Name of a bitstream's files, before their endings."""
SEED = 1
"""The seed with which bitstreams are placed."""
Progress = Callable[[str], None]
"""A function that is called with each step as it begins."""


def time_circuit(
    name: str,
    board: Board,
    parameters: Parameters,
    seeds: list[int],
    folder: Path,
    report_progress: Progress,
    jobs: int = 1,
) -> Timing:
    """Synthesise the circuit in its frame and place it with each seed, ``jobs`` at a time.

    Raises
    ------
    InputError
        If the device has too few resources.
    """
    flow = get_family(board.family).flow
    tools = Tools(board, folder, name=name, top=FRAME, pinned=False)
    report_progress("synthesis")
    verilog = framed(parameters)
    synthesised, frame = _without_frame(tools.synthesise(verilog), flow)
    check_fit(name, board.capacity.exceeded(synthesised))

    def placed(seed: int) -> dict:
        report_progress(f"seed {seed}")
        return tools.place_and_route(seed=seed, mhz=board.target_mhz)

    with ThreadPoolExecutor(jobs) as pool:
        reports = list(pool.map(placed, seeds))
    clocks = [report.fmax(found) for found in reports]
    middle = sorted(clocks)[(len(clocks) - 1) // 2]
    return Timing(
        version=version(),
        board=name,
        circuit=Circuit(**sizes_of(parameters)),
        resources=report.placed(reports[0], flow) - frame,
        seeds=seeds,
        fmax_mhz=clocks,
        clock_mhz=min(round(median(clocks), 2), board.limits_mhz.lowest),
        grade=board.grade,
        fmax_min=min(clocks),
        fmax_median=round(median(clocks), 2),
        limits_mhz=board.limits_mhz,
        frame=frame,
        critical_path=report.critical_path(reports[clocks.index(middle)], flow),
        tools=tools.versions(),
        verilog_sha256=_sha256(verilog.encode()),
    )


def smallest(name: str, board: Board, folder: Path) -> Smallest:
    """Synthesise the smallest circuit for a board's device."""
    parameters = board.parameters(**SMALLEST)
    tools = Tools(board, folder, name="smallest", top=FRAME, pinned=False)
    resources, _ = _without_frame(tools.synthesise(framed(parameters)), get_family(board.family).flow)
    return Smallest(version=version(), board=name, circuit=Circuit(**sizes_of(parameters)), resources=resources)


def board_tools(board: Board, folder: Path) -> Tools:
    """The tools for a board's top."""
    return Tools(board, folder, name=NAME, top=BOARD, pinned=True)


def build_bitstream(
    name: str,
    board: Board,
    parameters: Parameters,
    tools: Tools,
    report_progress: Progress,
    *,
    allow_missed: bool = False,
) -> Build:
    """Synthesise the board's top, place it and pack its bitstream with the `board_tools`.

    An earlier bitstream is removed first. A circuit that doesn't fit is not placed; one that misses its clock is not
    packed, unless ``allow_missed``. Neither is done for a family whose vendor's tool does it.

    Raises
    ------
    InputError
        As `hw.boards.top.board_top`, or if the board's clock is faster than a hard block.
    """
    tools.bitstream.unlink(missing_ok=True)
    report_progress("Verilog")
    verilog, mhz = board_top(board, parameters)
    _check_limits(board, mhz)
    report_progress("synthesis")
    flow = get_family(board.family).flow
    resources = flow.cells.resources(cell_counts(tools.synthesise(verilog)))
    build = Build(
        version=version(),
        board=name,
        circuit=Circuit(**sizes_of(parameters)),
        resources=resources,
        seeds=[],
        fmax_mhz=[],
        clock_mhz=mhz,
        baud=board.baud,
        exceeded=board.capacity.exceeded(resources),
        tools=tools.versions(),
        verilog_sha256=_sha256(verilog.encode()),
        bitstream_sha256=None,
    )
    if build.exceeded or flow.vendor:
        return build
    report_progress("placing")
    build.seeds = [SEED]
    build.fmax_mhz = [report.fmax(tools.place_and_route(seed=SEED, mhz=mhz))]
    if allow_missed or not build.missed():
        report_progress("packing")
        tools.pack(seed=SEED)
        build.bitstream_sha256 = _sha256(tools.bitstream.read_bytes())
    return build


def check_fit(name: str, exceeded: str) -> None:
    """Raise `InputError` if resources are exceeded."""
    if exceeded:
        raise InputError(f"the circuit must fit {name}, not take {exceeded}: choose fewer lanes, nodes or edges")


def _check_limits(board: Board, mhz: float) -> None:
    limits = board.limits_mhz
    if limits and mhz > limits.lowest:
        raise InputError(f"clock_mhz must be at most {limits.lowest:g}, the limit of its hard blocks, not {mhz:g}")


def _without_frame(statistics: dict, flow: Flow) -> tuple[Resources, Resources]:
    """Return the resources of the circuit and of the frame around it, after synthesis."""
    frame = flow.cells.resources(cell_counts(statistics, FRAME))
    return flow.cells.resources(cell_counts(statistics)) - frame, frame


def _sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()
