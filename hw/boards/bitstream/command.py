"""``python -m hw bitstream``: options, and what is written where."""

import sys

from golden.support.errors import InputError
from golden.support.paths import ROOT
from hw.boards import board as boards
from hw.boards.bitstream import flow, tools
from hw.boards.bitstream.result import KEPT, Build, table
from hw.boards.timing.command import progress
from hw.boards.timing.result import read, write
from hw.options import add_sizes
from hw.sizes import sizes_of

OUT = ROOT / "build" / "bitstream"


def add_options(command) -> None:
    command.add_argument("--board", required=True, metavar="NAME", help=" or ".join(boards.names()))
    add_sizes(command)
    command.add_argument("--timing-allow-fail", action="store_true", help="a bitstream even if the clock is missed")
    command.add_argument("--keep", action="store_true", help="write the figures below constraints/builds/ as well")


def run(args) -> int:
    board = boards.load(args.board)
    try:
        parameters = board.parameters(**sizes_of(args))
    except ValueError as error:
        raise InputError(f"--{error}") from None
    if args.keep and parameters != board.parameters():
        raise InputError("--keep must be of the board's own circuit")
    folder = OUT / args.board
    folder.mkdir(parents=True, exist_ok=True)
    with progress(4) as shown:
        build = flow.build(args.board, board, parameters, folder, shown, allow_missed=args.timing_allow_fail)
    print(table(build, board))
    for place in (folder / "build.json", *([KEPT / f"{args.board}.json"] if args.keep else [])):
        write(place, build)
        print(f"figures: {place.relative_to(ROOT)}", file=sys.stderr)
    boards.fits(args.board, build, board)
    if missed := build.missed():
        print(f"{'warning' if args.timing_allow_fail else 'error'}: {missed}", file=sys.stderr)
        if not args.timing_allow_fail:
            return 1
    ready = tools.bitstream(board, folder) if build.bitstream_sha256 else folder / f"{tools.NAME}.tcl"
    print(f"{'bitstream' if build.bitstream_sha256 else 'project'}: {ready.relative_to(ROOT)}")
    return 0


def kept() -> dict[str, Build]:
    """What is published, by board."""
    paths = {name: KEPT / f"{name}.json" for name in boards.names()}
    return {name: read(path, Build) for name, path in paths.items() if path.exists()}
