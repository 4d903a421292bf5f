"""The command line ``python -m sim COMMAND ...``: a command a module in `sim.commands`."""

from __future__ import annotations

import sys

from golden.support.command import Parser, command_parser, execute
from sim.commands import bench, compare, export, figures, report, run, serve

COMMANDS = {
    "run": run,
    "compare": compare,
    "figures": figures,
    "export": export,
    "report": report,
    "serve": serve,
    "bench": bench,
}


def parser() -> Parser:
    """Return the parser of all commands."""
    return command_parser("python -m sim", "Run scenes on float64, on integers and on the simulated circuit.", COMMANDS)


def main(arguments=None) -> int:
    """Return the exit code: that of `golden.support.command.execute`, or 1 when models disagree or something
    saturated."""
    return execute(parser(), arguments)


if __name__ == "__main__":
    sys.exit(main())
