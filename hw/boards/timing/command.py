"""``python -m hw timing``: options, progress and what is written where."""

import sys
from contextlib import contextmanager

from golden.support.errors import InputError
from golden.support.paths import ROOT
from hw.boards import board as boards
from hw.boards.timing import flow
from hw.boards.timing.result import KEPT, Result, Smallest, table, write
from hw.options import add_sizes, whole
from hw.sizes import sizes_of

OUT = ROOT / "build" / "timing"
SEEDS = [1, 2, 3]
MOST_JOBS = 64


def add_options(command) -> None:
    what = command.add_mutually_exclusive_group(required=True)
    what.add_argument("--board", metavar="NAME", help=" or ".join(boards.timed()))
    what.add_argument("--smallest", action="store_true", help="only the sizes of the smallest circuit")
    add_sizes(command)
    command.add_argument(
        "--seeds",
        type=whole,
        nargs="+",
        default=SEEDS,
        metavar="N",
        help="place and route so often, from these (1 2 3)",
    )
    command.add_argument("--jobs", type=whole, default=1, metavar="N", help="seeds at a time (1), 2 GB of memory each")
    command.add_argument("--keep", action="store_true", help="write the figures below constraints/timing/ as well")


def run(args) -> int:
    OUT.mkdir(parents=True, exist_ok=True)
    if args.smallest:
        with progress(1) as shown:
            shown("synthesis")
            result = flow.smallest(OUT)
        print(", ".join(f"{getattr(result.sizes, name)} {name}" for name in result.sizes.__struct_fields__))
        return _written("smallest", result, args.keep)
    chosen = sizes_of(args)
    board = boards.load(args.board)
    if board.family not in boards.TIMED:
        raise InputError(
            f"--board must be one whose device the tools time, {' or '.join(boards.timed())}, not {args.board!r}"
        )
    try:
        parameters = board.parameters(**chosen)
    except ValueError as error:
        raise InputError(f"--{error}") from None
    seeds = _checked_seeds(args.seeds)
    if not 1 <= args.jobs <= MOST_JOBS:
        raise InputError(f"--jobs must be 1 to {MOST_JOBS}, not {args.jobs}")
    if args.keep and (parameters != board.parameters() or len(seeds) < len(SEEDS)):
        raise InputError(f"--keep must be of the board's own circuit and at least {len(SEEDS)} seeds")
    with progress(1 + len(seeds)) as shown:
        result = flow.measure(args.board, board, parameters, seeds, OUT, shown, args.jobs)
    print(table(result, board))
    return _written(args.board, result, args.keep)


def _checked_seeds(seeds: list[int]) -> list[int]:
    for number, seed in enumerate(seeds):
        if not 1 <= seed < 1 << 31 or seed in seeds[:number]:
            raise InputError(f"--seeds must be different numbers from 1 to {(1 << 31) - 1}, not {seed}")
    return seeds


def _written(name: str, result: Result | Smallest, keep: bool) -> int:
    for folder in (OUT, *([KEPT] if keep else [])):
        write(folder / f"{name}.json", result)
        print(f"figures: {(folder / f'{name}.json').relative_to(ROOT)}", file=sys.stderr)
    return 0


@contextmanager
def progress(steps: int):
    """A bar on stderr; gives ``shown(what is done next)``, which does nothing where stderr is not a terminal."""
    if not sys.stderr.isatty():
        yield lambda doing: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = TextColumn("{task.description:9}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task("", total=steps, completed=-1)

        def shown(doing: str) -> None:
            bars.update(task, description=doing, advance=1)

        yield shown
