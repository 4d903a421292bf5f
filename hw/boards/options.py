"""Options and output that timing and bitstream share."""

import sys
from collections.abc import Iterable
from pathlib import Path

from golden.support.errors import InputError
from golden.support.paths import ROOT
from hw.boards import board as boards
from hw.boards.board import Board
from hw.boards.result import Smallest, write
from hw.options import add_sizes
from hw.parameters import Parameters
from hw.sizes import sizes_of


def add_board(command, folder: Path) -> None:
    """Add the options for a board's circuit, and for publishing its result in a folder."""
    command.add_argument("--board", required=True, metavar="NAME", help=" or ".join(boards.names()))
    add_sizes(command)
    below = f"{folder.parent.name}/{folder.name}/"
    command.add_argument("--keep", action="store_true", help=f"write the figures below {below} as well")


def chosen_circuit(args) -> tuple[Board, Parameters]:
    """Read the options that `add_board` added. Raises `InputError` for an impossible circuit."""
    board = boards.load(args.board)
    try:
        return board, board.parameters(**sizes_of(args))
    except ValueError as error:
        raise InputError(f"--{error}") from None


def write_figures(result: Smallest, paths: Iterable[Path]) -> None:
    """Write the result to each path, and name it on stderr."""
    for path in paths:
        write(path, result)
        print(f"figures: {path.relative_to(ROOT)}", file=sys.stderr)
