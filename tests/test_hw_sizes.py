"""The sizes of a circuit are in one table: a new row reaches everything that knows the sizes."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

from hw.link.identity import CIRCUIT
from hw.parameters import Parameters
from hw.sizes import SIZES, summary

ROOT = Path(__file__).resolve().parents[1]

ANOTHER = """
from hw.sizes import SIZES, Size

SIZES["pumps"] = Size("pumps", "pumps in the circuit", 3, 2, range(1, 9), "X", optional=True, column=True)

from hw import options
from hw.__main__ import parser
from hw.boards import board, flow, tables
from hw.emit import build, pages
from hw.emit.manifest import parameters
from hw.link.description import description, key
from hw.link.identity import Identity
from hw.map.control import Control, constants
from hw.parameters import Parameters

args = parser().parse_args(["verilog", "--pumps", "5"])
p = options.parameters(args)
assert p.pumps == 5 and Parameters().pumps == 3
assert parser().parse_args(["timing", "--board", "ulx3s-85f", "--pumps", "2"]).pumps == 2
assert board.load("ulx3s-85f").parameters().pumps == 3
assert board.load("ulx3s-85f").parameters(pumps=4).pumps == 4
assert list(tables.CIRCUIT)[-1] == "pumps" and flow.SMALLEST["pumps"] == 2
assert parameters(p)["pumps"] == 5
assert ", 5 pumps" in build.describe(p)
assert "#define RHEOGATE_PUMPS 5" in pages.header(p, description(p))
assert constants(p)[Control.PUMPS] == 5
assert any(register["name"] == "PUMPS" for register in description(p)["registers"])
identity = Identity.of(p, key(p), 1, 8)
assert Identity.read(identity.items) == identity and identity.parameters() == p
try:
    Parameters(pumps=9)
except ValueError as error:
    print(error)
"""


def test_another_size_reaches_everything():
    done = subprocess.run([sys.executable, "-c", ANOTHER], cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == "" and done.stdout == "pumps must be a whole number from 1 to 8, not 9\n"


def names_in(path: Path) -> set[str]:
    """Return the names of sizes in a file's strings, docstrings aside, and among its fields."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            found |= set(re.findall(r"\w+", node.value.lower())) if len(node.value.split()) == 1 else set()
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found.add(node.target.id)
    return found & set(SIZES)


@pytest.mark.parametrize("path", sorted((ROOT / "hw").rglob("*.py")), ids=lambda path: str(path.relative_to(ROOT)))
def test_nothing_else_lists_the_sizes(path):
    listed = names_in(path)
    assert listed == set(SIZES) if path.name == "sizes.py" else len(listed) <= 2, listed


def test_the_makefile_takes_every_size():
    makefile = (ROOT / "Makefile").read_text()
    (variables,) = re.findall(r"^SIZES := (.*)$", makefile, re.M)
    assert variables.split() == [name.upper() for name in SIZES]


@pytest.mark.parametrize(
    ("target", "given", "options"),
    [
        ("verilog", ["LANES=3", "AXES=1"], "--lanes 3 --updates 1 --axes 1"),
        ("timing", [], ""),
        ("timing", ["NODES=7", "UPDATES=2"], "--updates 2 --nodes 7"),
        ("bitstream", ["EDGES=9"], "--edges 9"),
    ],
)
def test_make_passes_on_the_sizes_that_are_given(target, given, options):
    done = subprocess.run(["make", "-n", target, *given], cwd=ROOT, capture_output=True, text=True, check=True)
    (line,) = (line for line in done.stdout.replace("\\\n", " ").splitlines() if f"-m hw {target}" in line)
    sizes = "|".join(SIZES)
    assert " ".join(re.findall(rf"--(?:{sizes}) \d+", line)) == options


def test_a_circuit_in_a_sentence():
    some = Parameters(lanes=1, updates=2, axes=1, tables=1)
    assert summary(some) == "1 lane, 2/3 updates, 512 nodes, 4096 edges, 16 materials, 1 table"


def test_every_number_of_the_identity_has_a_meaning():
    assert list(CIRCUIT) == [*SIZES, "operand", "state"] and all(CIRCUIT.values())
