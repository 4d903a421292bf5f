"""The command line: ``python -m hw COMMAND``, a module for each command."""

import sys

from golden.support.command import Parser, execute
from hw.boards import bitstream, doctor, flash, timing
from hw.commands import lint, map, verilog
from hw.docs import command as docs

COMMANDS = {
    "verilog": (verilog, "write the Verilog and its manifest"),
    "lint": (lint, "write the Verilog and check it with Verilator"),
    "map": (map, "write the memory map and the link's protocol as C header, page and JSON"),
    "timing": (timing, "place and route for a board: clock and size"),
    "bitstream": (bitstream, "build what is loaded into a board"),
    "flash": (flash, "load it"),
    "doctor": (doctor, "list what is installed, what is missing and what to do about it"),
    "docs": (docs, "bring the documents' tables and pictures up to date"),
}


def parser() -> Parser:
    main = Parser(prog="python -m hw", description="The circuit's Verilog, and what is made of it.")
    commands = main.add_subparsers(dest="command", required=True, metavar="|".join(COMMANDS))
    for name, (module, text) in COMMANDS.items():
        command = commands.add_parser(name, help=text)
        module.add_options(command)
        command.set_defaults(run=module.run)
    return main


def main(arguments=None) -> int:
    """Return the exit code: that of `golden.support.command.execute`, or 1 for warnings of the lint."""
    return execute(parser(), arguments)


if __name__ == "__main__":
    sys.exit(main())
