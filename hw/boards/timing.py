"""``python -m hw timing``: how fast and how large a circuit is on a board's device."""

from pathlib import Path

from golden.support.errors import InputError
from golden.support.paths import BUILD
from hw.boards import board as boards
from hw.boards import flow
from hw.boards.board import Board
from hw.boards.options import add_board, chosen_circuit, write_figures
from hw.boards.progress import progress
from hw.boards.result import Timing
from hw.boards.tables import timing_report
from hw.families.registry import get_family
from hw.options import whole
from hw.parameters import Parameters

OUT = BUILD / "timing"
SEEDS = [1, 2, 3]
MOST_JOBS = 64


def add_options(command) -> None:
    add_board(command, Timing.PUBLISHED)
    command.add_argument("--smallest", action="store_true", help="only the resources of a small circuit on its device")
    command.add_argument(
        "--seeds", type=whole, nargs="+", default=SEEDS, metavar="N", help="place and route with each of these (1 2 3)"
    )
    command.add_argument("--jobs", type=whole, default=1, metavar="N", help="seeds at a time (1), 2 GB of memory each")


def run(args) -> int:
    board, parameters = chosen_circuit(args)
    if not get_family(board.family).timed:
        known = " or ".join(boards.timed())
        raise InputError(f"--board must be one whose device the tools time, {known}, not {args.board!r}")
    OUT.mkdir(parents=True, exist_ok=True)
    return _smallest(args, board) if args.smallest else _timing(args, board, parameters)


def _smallest(args, board: Board) -> int:
    with progress(1) as begin:
        begin("synthesis")
        result = flow.smallest(args.board, board, OUT)
    print(", ".join(f"{use.used} {use.what}" for use in board.capacity.use(result.resources)))
    write_figures(result, _paths("smallest", args.keep))
    return 0


def _timing(args, board: Board, parameters: Parameters) -> int:
    seeds = _checked_seeds(args.seeds)
    if not 1 <= args.jobs <= MOST_JOBS:
        raise InputError(f"--jobs must be 1 to {MOST_JOBS}, not {args.jobs}")
    if args.keep and (parameters != board.parameters() or len(seeds) < len(SEEDS)):
        raise InputError(f"--keep must be of the board's own circuit and at least {len(SEEDS)} seeds")
    with progress(1 + len(seeds)) as begin:
        result = flow.time_circuit(args.board, board, parameters, seeds, OUT, begin, args.jobs)
    print(timing_report(result, board))
    write_figures(result, _paths(args.board, args.keep))
    return 0


def _checked_seeds(seeds: list[int]) -> list[int]:
    for number, seed in enumerate(seeds):
        if not 1 <= seed < 1 << 31 or seed in seeds[:number]:
            raise InputError(f"--seeds must be different numbers from 1 to {(1 << 31) - 1}, not {seed}")
    return seeds


def _paths(name: str, keep: bool) -> list[Path]:
    return [folder / f"{name}.json" for folder in (OUT, *([Timing.PUBLISHED] if keep else []))]
