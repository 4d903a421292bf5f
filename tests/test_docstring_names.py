"""Names in docstrings: whatever stands between single backticks with its full path exists."""

import ast
import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest
from test_words import SOURCES, TESTS, docstrings

from environment import ROOT

NAME = re.compile(r"(?<!`)`((?:golden|hw|sim)(?:\.\w+)+)`(?!`)")


def names(text: str) -> list[str]:
    """Return the names with a full path in the docstrings of a source text."""
    return [name for string in docstrings(ast.parse(text)) for name in NAME.findall(string.value)]


def exists(name: str) -> bool:
    """Return whether a module has that path, or something in a module: also an attribute that instances have."""
    parts = name.split(".")
    module = next((n for n in range(len(parts), 0, -1) if is_module(ROOT.joinpath(*parts[:n]))), 0)
    if not module:
        return False
    found = import_module(".".join(parts[:module]))
    for part in parts[module:]:
        if inspect.isclass(found) and not hasattr(found, part):
            return re.search(rf"^\s+(?:self\.)?{part}\b|, self\.{part}\b", inspect.getsource(found), re.M) is not None
        if not hasattr(found, part):
            return False
        found = getattr(found, part)
    return True


def is_module(path: Path) -> bool:
    return path.with_suffix(".py").is_file() or (path / "__init__.py").is_file()


def test_names_with_a_full_path_exist():
    found = {name: str(path.relative_to(ROOT)) for path in SOURCES + TESTS for name in names(path.read_text())}
    assert len(found) > 100
    assert {name: path for name, path in found.items() if not exists(name)} == {}


@pytest.mark.parametrize(
    "name", ["hw.front", "hw.machine.lane.Line", "hw.machine.lane.Lane.nothing", "sim.order.order"]
)
def test_a_name_that_is_gone_is_noticed(name):
    assert names(f'"""See `{name}`, not ``hw.no.name``."""') == [name]
    assert not exists(name)
