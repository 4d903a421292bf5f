"""The command line ``python -m golden COMMAND ...``: a command a module in `golden.commands`."""

from __future__ import annotations

import sys

from golden.commands import mesh
from golden.support.command import Parser, command_parser, execute

COMMANDS = {"mesh": mesh}


def parser() -> Parser:
    """Return the parser of all commands."""
    return command_parser("python -m golden", "The specification one can run.", COMMANDS)


def main(arguments=None) -> int:
    """Return the exit code: that of `golden.support.command.execute`."""
    return execute(parser(), arguments)


if __name__ == "__main__":
    sys.exit(main())
