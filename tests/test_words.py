"""Words and sizes: docstrings begin with a verb or a noun, names aren't built at run time, files stay small."""

import ast
import re
from pathlib import Path
from statistics import median

import pytest

from environment import ROOT

SOURCES = [path for package in ("golden", "hw", "sim") for path in sorted((ROOT / package).rglob("*.py"))]
TESTS = sorted((ROOT / "tests").glob("*.py"))
DECODED = re.compile(r"(?:Of|That of|What|Those|Whether|Where)\b")
"""A docstring that begins so has to be decoded."""

BUILT_NAMES = 30
"""The most calls of getattr with a name that is built at run time, in golden, hw and sim together."""

MEDIAN_LINES, MOST_LINES = 110, 300


def docstrings(tree: ast.AST) -> list[ast.Constant]:
    """Return the docstrings of modules, classes and functions, and the strings after assignments and fields."""
    strings = []
    for node in ast.walk(tree):
        for body in (getattr(node, "body", None), getattr(node, "orelse", None)):
            statements = body if isinstance(body, list) else []
            values = [statement.value for statement in statements if isinstance(statement, ast.Expr)]
            strings += [value for value in values if isinstance(value, ast.Constant) and isinstance(value.value, str)]
    return strings


def decoded(text: str) -> list[tuple[int, str]]:
    """Return (line, beginning) of each docstring of a source text that begins with a word of `DECODED`."""
    found = [(string.lineno, string.value.strip()) for string in docstrings(ast.parse(text))]
    return [(line, string[:40]) for line, string in found if DECODED.match(string)]


def built_names(text: str) -> list[int]:
    """Return the line of each getattr whose name isn't a literal."""
    calls = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)]
    calls = [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "getattr"]
    return [call.lineno for call in calls if not isinstance(call.args[1], ast.Constant)]


def test_docstrings_begin_with_a_verb_or_a_noun():
    found = {str(path.relative_to(ROOT)): decoded(path.read_text()) for path in SOURCES + TESTS}
    assert {path: lines for path, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    "text",
    [
        '"""Of a module."""',
        'class A:\n    """That of a class."""',
        'def f():\n    """What it gives."""',
        'A = 1\n"""Those that count."""',
        'class A:\n    a: int\n    """Whether it is one."""',
        'async def f():\n    """Where it stands."""',
    ],
)
def test_a_docstring_to_decode_is_noticed(text):
    assert len(decoded(text)) == 1
    assert not decoded(re.sub("Of|That of|What|Those|Whether|Where", "Offset of", text))


def test_few_names_are_built_at_run_time():
    found = {str(path.relative_to(ROOT)): built_names(path.read_text()) for path in SOURCES}
    found = {path: lines for path, lines in found.items() if lines}
    assert sum(map(len, found.values())) <= BUILT_NAMES, found


def test_a_built_name_is_noticed():
    assert built_names("getattr(a, f'x_{n}')\ngetattr(a, name, 0)\ngetattr(a, 'x')\na.x") == [1, 2]


def lines(path: Path) -> int:
    return len(path.read_text().splitlines())


def test_files_are_small():
    assert {str(path.relative_to(ROOT)): lines(path) for path in SOURCES + TESTS if lines(path) > MOST_LINES} == {}
    assert median(lines(path) for path in SOURCES) <= MEDIAN_LINES
