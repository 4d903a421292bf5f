"""Files that are there whole or not at all."""

import itertools
import os
from contextlib import contextmanager
from pathlib import Path

_numbers = itertools.count()
"""So that threads don't share a file that isn't whole yet."""


@contextmanager
def replaced(path: Path):
    """An open binary file that takes the place of ``path`` at the end, unless an exception ends it."""
    with replacing(path) as partial, open(partial, "wb") as file:
        yield file


@contextmanager
def replacing(path: Path):
    """The path of a file to write, which takes the place of ``path`` at the end, unless an exception ends it."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.{next(_numbers)}")
    try:
        yield partial
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a file as a whole, in UTF-8."""
    with replaced(path) as file:
        file.write(text.encode())
