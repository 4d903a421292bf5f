"""Options that several commands share, and what they say."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path


def add_out(command: ArgumentParser, default: str | None, what: str) -> None:
    """Add ``--out DIR``, required if there is no default, and ``--force``."""
    suffix = f" ({default})" if default else ""
    command.add_argument("--out", default=default, required=not default, metavar="DIR", help=f"{what}{suffix}")
    add_force(command)


def add_force(command: ArgumentParser) -> None:
    """Add ``--force``."""
    command.add_argument("--force", action="store_true", help="write into DIR even if other files are there")


def add_json(command: ArgumentParser, what: str) -> None:
    """Add ``--json``."""
    command.add_argument("--json", action="store_true", help=f"print the contents of {what}")


def print_json(args: Namespace, path: Path) -> bool:
    """Print a file if ``--json`` is given; return whether it is."""
    if args.json:
        print(path.read_text(encoding="utf-8"), end="")
    return args.json
