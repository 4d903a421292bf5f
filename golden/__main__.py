"""The command line ``python -m golden COMMAND ...``: a command a module in `golden.commands`."""

from __future__ import annotations

import sys

from golden.commands import mesh
from golden.support.command import Parser, execute

COMMANDS = {"mesh": mesh}


def parser() -> Parser:
    """Return the parser of all commands."""
    main = Parser(prog="python -m golden", description="The specification one can run.")
    commands = main.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, module in COMMANDS.items():
        command = commands.add_parser(name, help=module.HELP)
        module.add_options(command)
        command.set_defaults(run=module.run)
    return main


def main(arguments=None) -> int:
    """Return the exit code: that of `golden.support.command.execute`."""
    return execute(parser(), arguments)


if __name__ == "__main__":
    sys.exit(main())
