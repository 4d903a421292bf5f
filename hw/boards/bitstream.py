"""``python -m hw bitstream``: a board's bitstream, or a project for its vendor's tool."""

import sys

from golden.support.errors import InputError
from golden.support.paths import BUILD, ROOT
from hw.boards import flow
from hw.boards.options import add_board, chosen_circuit, write_figures
from hw.boards.progress import progress
from hw.boards.result import Build
from hw.boards.tables import build_report

OUT = BUILD / "bitstream"
STEPS = 4
"""Most steps that `hw.boards.flow.build_bitstream` reports."""


def add_options(command) -> None:
    add_board(command, Build.PUBLISHED)
    command.add_argument("--timing-allow-fail", action="store_true", help="a bitstream even if the clock is missed")


def run(args) -> int:
    """Return the exit code: 1 if the clock is missed."""
    board, parameters = chosen_circuit(args)
    if args.keep and parameters != board.parameters():
        raise InputError("--keep must be of the board's own circuit")
    folder = OUT / args.board
    folder.mkdir(parents=True, exist_ok=True)
    tools = flow.board_tools(board, folder)
    with progress(STEPS) as begin:
        build = flow.build_bitstream(args.board, board, parameters, tools, begin, allow_missed=args.timing_allow_fail)
    print(build_report(build, board))
    published = [Build.PUBLISHED / f"{args.board}.json"] if args.keep else []
    write_figures(build, [folder / "build.json", *published])
    flow.check_fit(args.board, build.exceeded)
    if missed := build.missed():
        print(f"{'warning' if args.timing_allow_fail else 'error'}: {missed}", file=sys.stderr)
        if not args.timing_allow_fail:
            return 1
    what, path = ("bitstream", tools.bitstream) if build.bitstream_sha256 else ("project", tools.script)
    print(f"{what}: {path.relative_to(ROOT)}")
    return 0
