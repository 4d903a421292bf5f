"""Files that are there whole or not at all."""

import itertools
import os
from contextlib import contextmanager
from pathlib import Path

_numbers = itertools.count()
"""Numbers for partial files, so that two threads never share one."""


@contextmanager
def atomic_file(path: Path):
    """Open a binary file that takes the place of ``path`` at the end, unless an exception ends it."""
    with atomic_path(path) as partial, open(partial, "wb") as file:
        yield file


@contextmanager
def atomic_path(path: Path):
    """Yield the path of a file to write, which takes the place of ``path`` at the end, unless an exception ends it."""
    partial = path.with_name(f".{path.name}.{os.getpid()}.{next(_numbers)}")
    try:
        yield partial
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a file as a whole, in UTF-8."""
    with atomic_file(path) as file:
        file.write(text.encode())
