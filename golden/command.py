"""What the project's command lines share: one line an error, and the exit codes."""

import argparse
import sys

from golden.errors import InputError, InternalError


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
