"""Command lines: one line an error, the exit codes, and a status line while something takes long."""

import argparse
import sys
from contextlib import contextmanager
from types import ModuleType

from golden.support.errors import InputError, InternalError


class Parser(argparse.ArgumentParser):
    """A parser that raises `InputError` for a wrong argument, as everything else does for the user's mistakes."""

    def error(self, message):
        raise InputError(f"{message} (see {self.prog} --help)")


def command_parser(prog: str, description: str, commands: dict[str, ModuleType]) -> Parser:
    """Return the parser of a program whose commands are modules: each has ``HELP``, ``add_options`` and ``run``."""
    main = Parser(prog=prog, description=description)
    subparsers = main.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, module in commands.items():
        command = subparsers.add_parser(name, help=module.HELP)
        module.add_options(command)
        command.set_defaults(run=module.run)
    return main


def execute(parser: Parser, arguments=None) -> int:
    """Call the ``run`` that the arguments choose, with them.

    Returns
    -------
    int
        The exit code: what ``run`` returns, 1 for an `InternalError`, 2 for an `InputError`, 130 if interrupted.
    """
    try:
        args = parser.parse_args(arguments)
        return args.run(args)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except InternalError as error:
        print(f"internal error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130


@contextmanager
def status_line(text: str):
    """Show a line on the terminal, and clear it when the block ends; print nothing if stderr is no terminal."""
    watched = sys.stderr.isatty()
    if watched:
        print(text, end="\r", file=sys.stderr, flush=True)
    try:
        yield
    finally:
        if watched:
            print(" " * len(text), end="\r", file=sys.stderr, flush=True)
