"""Rooms: which folder of golden, hw and sim may import which, and no other arrow."""

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from environment import ROOT

PACKAGES = "golden", "hw", "sim"

ALLOWED = {
    "golden/__main__": "golden/commands golden/support",
    "golden/commands": "golden/mesh golden/scene golden/support",
    "golden/datapath": "golden/numbers",
    "golden/mesh": "golden/support",
    "golden/physics": "golden/mesh golden/support",
    "golden/scene": "golden/datapath golden/mesh golden/physics golden/support",
    "hw/__main__": "golden/support hw/boards hw/commands hw/docs",
    "hw/blocks": "golden/numbers",
    "hw/boards": "environment golden/scene golden/support hw/blocks hw/emit hw/families hw/link hw/machine "
    "hw/options hw/parameters hw/sizes",
    "hw/commands": "golden/support hw/emit hw/options",
    "hw/docs": "golden/datapath golden/support hw/blocks hw/boards hw/emit hw/machine hw/map hw/parameters",
    "hw/emit": "golden/support hw/blocks hw/families hw/link hw/machine hw/parameters hw/sizes",
    "hw/families": "golden/scene golden/support hw/blocks hw/pipeline",
    "hw/link": "golden/datapath golden/numbers hw/blocks hw/machine hw/map hw/parameters hw/sizes",
    "hw/machine": "golden/datapath golden/numbers hw/blocks hw/map hw/parameters hw/pipeline",
    "hw/map": "golden/datapath golden/numbers hw/parameters hw/sizes",
    "hw/options": "golden/datapath golden/support hw/families hw/parameters hw/sizes",
    "hw/parameters": "golden/datapath hw/families hw/pipeline hw/sizes",
    "hw/pipeline": "golden/datapath golden/numbers hw/blocks",
    "hw/sizes": "golden/datapath golden/numbers",
    "sim/__main__": "golden/support sim/commands",
    "sim/backends": "golden/datapath golden/numbers golden/physics golden/support hw/emit hw/link hw/machine "
    "hw/map hw/parameters hw/pipeline hw/sizes sim/encode sim/support",
    "sim/commands": "golden/scene golden/support sim/backends sim/compare sim/encode sim/figures sim/report "
    "sim/results sim/run sim/speed sim/support",
    "sim/compare": "golden/physics sim/backends sim/results sim/run",
    "sim/encode": "golden/datapath golden/numbers golden/physics golden/scene golden/support hw/map hw/parameters",
    "sim/figures": "golden/mesh golden/physics golden/scene golden/support sim/backends sim/report sim/results "
    "sim/run sim/support",
    "sim/report": "golden/datapath golden/mesh golden/physics golden/support sim/backends sim/compare "
    "sim/results sim/support",
    "sim/results": "golden/datapath golden/mesh golden/numbers golden/physics golden/scene golden/support "
    "hw/boards hw/machine hw/parameters hw/sizes sim/backends sim/encode",
    "sim/run": "golden/physics golden/support sim/backends sim/encode sim/results",
    "sim/speed": "golden/datapath golden/mesh golden/physics golden/support sim/support",
    "sim/support": "golden/physics golden/support",
}
"""By room, the rooms that it imports; a room that isn't listed imports none."""

REASONS = {
    ("golden/scene", "golden/datapath"): "a node with more edges than an accumulator can sum is refused with the scene",
    ("hw/boards", "environment"): "the doctor lists which of the checkout's packages are missing",
    ("hw/boards", "golden/scene"): "boards' files are TOML like scene files, with the same checks and messages",
    ("hw/families", "golden/scene"): "pins and devices in boards' files have the types of scene files",
    ("hw/families", "hw/pipeline"): "a family has its own cost of operations",
    ("hw/parameters", "hw/families"): "the family is one of a circuit's parameters",
    ("hw/parameters", "hw/pipeline"): "the cost of operations is one of a circuit's parameters",
    ("hw/pipeline", "golden/datapath"): "the table of quantities says after which of them a register is added",
    ("hw/pipeline", "hw/blocks"): "the latency of a block is the cost of its operation",
    ("sim/backends", "golden/physics"): "the float backend is the float64 model",
    ("sim/backends", "hw/pipeline"): "the edge's pipeline is built alone, to time it beside the compiled equations",
    ("sim/results", "hw/boards"): "the time of a step on a board follows from its published clock",
    ("sim/results", "sim/backends"): "results call backends by their words",
    ("sim/figures", "sim/report"): "figures and page share their colours",
}
"""Why an arrow that surprises is allowed."""


def room(module: str) -> str:
    """Return the room of a module, by its dotted name: the folder, or the file, right below its package."""
    return "/".join(module.split(".")[:2])


def statements(tree: ast.AST):
    """Yield all nodes of a file except imports for type checkers alone, which nothing waits for at run time."""
    for node in ast.iter_child_nodes(tree):
        if not (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"):
            yield node
            yield from statements(node)


def imported(path: Path) -> set[str]:
    """Return the rooms that a file imports, those of a function's own imports among them."""
    names = set()
    for node in statements(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} must import by absolute names, not {'.' * node.level}{node.module or ''}"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
    rooms = {room(name) for name in names if name.split(".")[0] in PACKAGES}
    return rooms | {"environment" for name in names if name.split(".")[0] == "environment"}


def arrows(root: Path = ROOT) -> set[tuple[str, str]]:
    """Return (importing room, imported room) for all files of the packages."""
    found = set()
    for path in (path for package in PACKAGES for path in (root / package).rglob("*.py")):
        own = room(".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__"))
        found |= {(own, other) for other in imported(path) if other != own}
    return found


TABLE = {(one, other) for one, others in ALLOWED.items() for other in others.split()}


def test_imports_between_rooms_are_those_of_the_table():
    assert arrows() - TABLE == set(), "imports that the table doesn't allow"
    assert TABLE - arrows() == set(), "arrows of the table that nobody uses"


def test_no_arrow_runs_back():
    tuple(TopologicalSorter({one: others.split() for one, others in ALLOWED.items()}).static_order())
    order = {package: number for number, package in enumerate(("environment", *PACKAGES))}
    assert all(order[one.split("/")[0]] >= order[other.split("/")[0]] for one, other in TABLE)


def test_reasons_are_of_arrows_in_the_table():
    assert REASONS.keys() <= TABLE


def test_a_planted_import_is_noticed(tmp_path):
    """A function's own import in a new file, and a relative one, which is refused."""
    (tmp_path / "golden" / "physics").mkdir(parents=True)
    file = tmp_path / "golden" / "physics" / "new.py"
    file.write_text("def f():\n    from hw.machine import lane\n")
    assert arrows(tmp_path) - TABLE == {("golden/physics", "hw/machine")}
    file.write_text("from ..mesh import mesh\n")
    with pytest.raises(AssertionError, match=r"must import by absolute names, not \.\.mesh"):
        arrows(tmp_path)


FOLDERS = sorted({path.parent for package in PACKAGES for path in (ROOT / package).rglob("*.py")})


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: str(folder.relative_to(ROOT)))
def test_a_folder_says_in_three_lines_what_lives_there(folder):
    docstring = ast.get_docstring(ast.parse((folder / "__init__.py").read_text()))
    assert docstring and len(docstring.splitlines()) <= 3
