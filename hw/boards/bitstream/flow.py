"""From a board to its bitstream: Verilog, synthesis, place and route, timing, packing."""

import hashlib
from collections.abc import Callable
from pathlib import Path

from golden.support.errors import InputError
from hw.boards.bitstream import tools
from hw.boards.bitstream.result import Build
from hw.boards.board import Board, too_many
from hw.boards.timing.report import fmax
from hw.boards.top import board_top
from hw.families import cells
from hw.parameters import Parameters
from hw.sizes import sizes_of


def build(
    name: str,
    board: Board,
    parameters: Parameters,
    folder: Path,
    shown: Callable[[str], None],
    *,
    allow_missed: bool = False,
) -> Build:
    """Everything that a `Build` holds; ``shown`` is told what is being done.

    The files of an earlier build that would be written again are removed first. A circuit that doesn't fit is not
    placed, one that misses its clock is not packed, unless ``allow_missed``; neither is a family's without open tools.

    Raises
    ------
    InputError
        As `hw.boards.top.board_top`, or if a hard block isn't as fast as the board's clock.
    """
    shown("Verilog")
    made = tools.bitstream(board, folder)
    made.unlink(missing_ok=True)
    verilog, mhz = board_top(board, parameters)
    _slow_enough(board, mhz)
    shown("synthesis")
    sizes = cells.sizes(tools.synthesise(board, verilog, folder), board.family)
    result = Build(
        board=name,
        **sizes_of(parameters),
        clock_mhz=mhz,
        baud=board.baud,
        **{size: getattr(sizes, size) for size in sizes.__struct_fields__},
        over=too_many(sizes, board),
        fmax_mhz=None,
        tools=tools.versions(board.family),
        verilog_sha256=hashlib.sha256(verilog.encode()).hexdigest(),
        bitstream_sha256=None,
    )
    if result.over or tools.CHAINS[board.family].place_and_route is None:
        return result
    shown("placing")
    result.fmax_mhz = fmax(tools.place_and_route(board, mhz, folder))
    if allow_missed or not result.missed():
        shown("packing")
        tools.pack(board, folder)
        result.bitstream_sha256 = hashlib.sha256(made.read_bytes()).hexdigest()
    return result


def _slow_enough(board: Board, mhz: float) -> None:
    limits = board.limits_mhz
    if limits and mhz > (most := min(limits.multiplier, limits.block_ram)):
        raise InputError(f"clock_mhz must be at most {most:g}, what the hard blocks stand (limits_mhz), not {mhz:g}")
