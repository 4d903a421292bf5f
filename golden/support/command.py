"""What the project's command lines share: one line an error, the exit codes, and a word while something takes long."""

import argparse
import sys
from contextlib import contextmanager

from golden.support.errors import InputError, InternalError


class Parser(argparse.ArgumentParser):
    """One line an error, as for every other mistake of the user's."""

    def error(self, message):
        raise InputError(f"{message} (see {self.prog} --help)")


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
def said_meanwhile(text: str):
    """A line on the terminal, gone when it's done; nothing where nobody watches."""
    watched = sys.stderr.isatty()
    if watched:
        print(text, end="\r", file=sys.stderr, flush=True)
    try:
        yield
    finally:
        if watched:
            print(" " * len(text), end="\r", file=sys.stderr, flush=True)
