"""Types of options on the command line: each returns a value or says what it must be."""

from argparse import ArgumentTypeError
from math import inf, nan


def whole(text: str) -> int:
    """Return a whole number of at least 1."""
    if not text.isdecimal() or int(text) < 1:
        raise ArgumentTypeError(f"must be a whole number of at least 1, not {text!r}")
    return int(text)


def port_number(text: str) -> int:
    """Return the number of a TCP port; 0 stands for any that is free."""
    if not text.isdecimal() or int(text) >= 1 << 16:
        raise ArgumentTypeError(f"must be a whole number from 0 to {(1 << 16) - 1}, not {text!r}")
    return int(text)


def megahertz(text: str) -> float:
    """Return a finite frequency above 0."""
    try:
        clock = float(text)
    except ValueError:
        clock = nan
    if not 0 < clock < inf:
        raise ArgumentTypeError(f"must be a finite number above 0, not {text!r}")
    return clock
