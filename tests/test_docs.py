"""The documents are true: the tutorial and all commands run, figures are the code's, links lead somewhere."""

import re
import shlex
from pathlib import Path

import documents
import pytest

from environment import ROOT
from golden.datapath.rk4 import RK4
from golden.physics import stability
from golden.scene import capacity
from golden.scene import load as scene
from hw.emit.latencies import latencies
from hw.machine.core import datapaths
from hw.parameters import Parameters
from sim.results.comparison import BOUND, power
from sim.results.cycles import cycles_per_step

PARAMETERS = Parameters()
FORMATS = PARAMETERS.formats
UPDATED = "issue to its new state in the lanes' memories"
every_page = pytest.mark.parametrize("path", documents.PAGES, ids=lambda path: path.stem)


def text(name):
    return (ROOT / "docs" / f"{name}.md").read_text()


def test_the_tutorial_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    blocks = documents.blocks(text("tutorial"))
    reader = documents.Reader(capsys)
    for block in blocks:
        reader.take(block, tmp_path)
    count = {language: sum(block.language == language for block in blocks) for language in ("toml", "sh", "python")}
    assert count["toml"] >= 3 and count["sh"] >= 6 and count["python"] >= 3


def test_what_the_tutorial_says_is_looked_at(tmp_path, monkeypatch, capsys):
    """Other words, another number or another exit code than those of a block are noticed."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my").mkdir()
    reader = documents.Reader(capsys)
    for printed, said in (("a 1.0 b", "a 1.0 c"), ("a 1.0", "a 1.3"), ("error: a", "error: a")):
        reader.take(documents.Block("python", "", f"print({printed!r})"), tmp_path)
        with pytest.raises(AssertionError):
            reader.take(documents.Block("text", "", said + "\n"), tmp_path)
    reader.take(documents.Block("python", "", "print('took 1.3 in 2 s, all')"), tmp_path)
    reader.take(documents.Block("text", "", "took 1.2 in 9 s, all\n"), tmp_path)


@every_page
def test_links_lead_somewhere(path):
    targets = re.findall(r"\]\(([^)#]+)[^)]*\)", path.read_text())
    assert targets
    for target in targets:
        assert (path.parent / target).exists(), target


@every_page
def test_links_into_a_page_lead_to_a_heading(path):
    for target, heading in re.findall(r"\]\(([^)#]*)#([^)]*)\)", path.read_text()):
        headings = re.findall(r"^#+ (.*)$", (path.parent / target if target else path).read_text(), re.MULTILINE)
        assert heading in [re.sub(r"[^\w -]", "", words).lower().replace(" ", "-") for words in headings], heading


@every_page
def test_the_readme_links_to_it(path):
    assert path.name == "README.md" or f"](docs/{path.name})" in (ROOT / "README.md").read_text()


def gone(path):
    """Return the files and folders that a page names and that don't exist."""
    named = re.findall(r"`((?:golden|hw|sim|scenes|tests|docs|constraints)/[\w./-]*)`", path.read_text())
    return [name for name in named if not (ROOT / name).exists()]


@every_page
def test_files_and_folders_exist(path):
    assert gone(path) == []


ERRANDS = [
    "A quantity's format",
    "A preset",
    "A damper law",
    "A board",
    "A device family",
    "A simulator backend",
    "A bus in front of the host port",
    "A timing path that is too long",
    "A report panel",
    "A command",
]


def test_every_errand_names_its_files_and_its_tests():
    """Files that exist are held by `test_files_and_folders_exist`."""
    sections = re.split(r"^## (.*)$", text("changing"), flags=re.MULTILINE)[1:]
    assert sections[::2] == ERRANDS
    for errand, section in zip(sections[::2], sections[1::2], strict=True):
        steps, _, checks = section.partition("Checked by")
        assert re.search(r"^1\. ", steps, re.MULTILINE) and re.search(r"`(?:golden|hw|sim|constraints)/", steps), errand
        assert re.search(r"`tests/test_\w+\.py`", checks), errand


def test_a_file_that_is_gone_is_noticed(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("First `hw/parameters.py`, then `hw/nowhere.py` and `sim/nowhere/`.")
    assert gone(page) == ["hw/nowhere.py", "sim/nowhere/"]


@every_page
def test_make_targets_exist(path):
    assert set(re.findall(r"(?:`|^)make ([a-z]+)", path.read_text(), re.MULTILINE)) <= documents.targets()


@every_page
def test_commands_parse(path):
    for line in documents.commands(path):
        package, *arguments = shlex.split(line)
        documents.PARSERS[package]().parse_args(arguments)


ELSEWHERE = "sim figures", "sim serve", "socket://"
"""Minutes, or two terminals: test_sim_figures_make.py and test_sim_backends_link_board.py run these."""


def test_commands_run(tmp_path, monkeypatch):
    """Every command of every page but the tutorial, once, in the pages' order: what one writes the next ones use."""
    monkeypatch.chdir(tmp_path)
    (block,) = (block for block in documents.blocks(text("scenes")) if block.language == "toml")
    Path(block.name).write_text(block.text)
    part = "mesh disc --radius 50 --edge 10 --out part.msh"  # some mesh of the reader's
    assert documents.COMMANDS["golden"](shlex.split(part)) == 0
    pages = [path for name in ("scenes", "runs") for path in documents.PAGES if path.stem == name]
    pages += [path for path in documents.PAGES if path not in pages and path.stem != "tutorial"]
    lines = dict.fromkeys(line for path in pages for line in documents.commands(path))
    chosen = [line for line in lines if not any(words in line for words in ELSEWHERE)]
    for line in chosen:
        package, *arguments = shlex.split(line)
        assert documents.COMMANDS[package](arguments) == 0, line
    assert len(chosen) >= 7 and Path("build/my-page/index.html").exists() and Path("build/my-run/vtu/run.pvd").exists()


def figures_of_the_method():
    return [
        f"{RK4.stages} evaluations of\nall edges",
        f"must stay below {stability.HALF_DISC}, of which {stability.TURNING} is used",
        f"whole number of {FORMATS.state} bits",
        f"last bit is 2^-{FORMATS.position.frac_bits} of the object's size",
        f"factors of {FORMATS.operand} bits",
        f"below {power(BOUND[False])} of the\nobject's size, and {power(BOUND[True])} with dampers",
        f"holds {PARAMETERS.nodes} nodes and {PARAMETERS.edges} edges, {PARAMETERS.materials} materials, and "
        f"{PARAMETERS.tables} of them",
        f"no more than {capacity.max_edges_at_node(FORMATS)} edges may meet at a node",
    ]


def figures_of_the_circuit():
    edge, node = (
        [n for n in datapath.graph.operations if n.kind == "mul" and not PARAMETERS.cost.narrow_product(n)]
        for datapath in datapaths(PARAMETERS)
    )
    cycles = {what: number for _, what, number in latencies(PARAMETERS)}
    busiest = cycles_per_step(scene.load(ROOT / "scenes" / "viscoelastic-3d.toml"), PARAMETERS.lanes, 1)
    return [
        f"takes {RK4.stages} rounds",
        f"{len(edge)} multipliers of {FORMATS.operand} bits",
        f"sums {cycles['issue to its force on both nodes']} cycles after its issue",
        f"another {len(node)} multipliers",
        f"copy {cycles[UPDATED]} cycles later",
        f"wide enough for {capacity.max_edges_at_node(FORMATS)}\nedges",
        f"At least {cycles['issue of an edge to its issue in the next stage, at least']} cycles lie",
        f"{busiest} cycles are {busiest / 100:.1f} microseconds",
        f"State words have {FORMATS.state} bits",
        f"factors have {FORMATS.operand} bits",
        f"with {1 << FORMATS.inverse_index.width} linear segments",
        f"two curves of {1 << FORMATS.damper_index.width} segments",
        f"for {PARAMETERS.nodes} nodes and {PARAMETERS.edges} edges",
    ]


@pytest.mark.parametrize(("name", "figures"), [("method", figures_of_the_method), ("circuit", figures_of_the_circuit)])
def test_figures_are_the_codes(name, figures):
    said = " ".join(text(name).split())
    for figure in figures():
        assert " ".join(figure.split()) in said, figure


def test_cycles_of_a_step_are_the_cycle_models():
    rows = re.findall(r"^\| (scenes/\S+) \| (\d+) \| (\d) \| (\d+) \| (\d+) %", text("circuit"), re.MULTILINE)
    assert len(rows) == 5
    for path, edges, lanes, cycles, busy in rows:
        one = scene.load(ROOT / path)
        expected = cycles_per_step(one, int(lanes), 1)
        issued = 100 * 4 * -(-len(one.mesh.edges) // int(lanes)) / expected
        assert (int(edges), int(cycles)) == (len(one.mesh.edges), expected)
        assert int(busy) == round(issued)
