"""The command line ``python -m sim COMMAND ...``: a command a module in `sim.commands`."""

from __future__ import annotations

import sys

from golden.support.command import Parser, execute
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
    main = Parser(prog="python -m sim", description="Run scenes on float64, on integers and on the simulated circuit.")
    commands = main.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, module in COMMANDS.items():
        command = commands.add_parser(name, help=module.HELP)
        module.add_options(command)
        command.set_defaults(run=module.run)
    return main


def main(arguments=None) -> int:
    """Return the exit code: that of `golden.support.command.execute`, or 1 when models disagree or something
    saturated."""
    return execute(parser(), arguments)


if __name__ == "__main__":
    sys.exit(main())
