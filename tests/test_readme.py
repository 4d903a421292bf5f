"""The README is true: its tables are what the code gives now, its scene runs, its commands exist."""

import re
import shlex
from pathlib import Path

import documents
import pytest

from golden import __main__ as golden
from golden.physics import model
from golden.scene import load as scene
from hw import __main__ as cli
from hw.docs import TABLES, updated
from hw.parameters import Parameters
from sim import __main__ as sim

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text()


def blocks(language: str = "") -> list[str]:
    return [block.text for block in documents.blocks(README) if block.language == language]


def test_tables_are_fresh():
    assert updated(README) == README, "run `python -m hw docs`"


def test_docs_brings_the_tables_up_to_date(tmp_path, monkeypatch, capsys):
    readme = tmp_path / "README.md"
    readme.write_text(README.replace("| position | Q3.33 |", "| position | Q3.32 |"))
    monkeypatch.setattr(cli, "ROOT", tmp_path)
    assert cli.main(["docs"]) == 0 and cli.main(["docs"]) == 0
    assert readme.read_text() == README
    assert tuple(capsys.readouterr()) == ("README.md: tables written anew\nREADME.md: up to date\n", "")


@pytest.mark.parametrize("name", TABLES)
def test_a_table_without_markers_is_named(name):
    message = f"the text must have the markers of the table {name!r}, but has not"
    with pytest.raises(ValueError, match=re.escape(message)):
        updated(README.replace(f"<!-- end of {name} -->", ""))


def test_a_stale_table_is_noticed():
    stale = README.replace("| position | Q3.33 |", "| position | Q3.32 |")
    assert stale != README
    assert updated(stale) == README


def test_other_lanes_change_the_latency_table_only_where_they_must():
    four, one = (TABLES["latency"](Parameters(lanes=lanes)).splitlines() for lanes in (4, 1))
    changed = [a.split("|")[1:3] for a, b in zip(four, one, strict=True) if a != b]
    assert [of.strip() for of, _ in changed] == ["node", "stage"]  # fewer sums to add up


def test_the_scene_runs(tmp_path):
    (text,) = blocks("toml")
    file = tmp_path / "my.toml"
    file.write_text(text)
    example = scene.load(file)
    assert len(example.frames) >= 60
    run = model.simulate(example)
    height = run.x[:, :, 1].max(axis=1)
    assert height.min() < 0.076 < 0.08 < height[-1] < 0.097  # pressed, and back part of the way


@pytest.mark.parametrize(("package", "parser"), [("sim", sim.parser), ("golden", golden.parser), ("hw", cli.parser)])
def test_commands_parse(package, parser):
    lines = [line for block in blocks() for line in block.splitlines() if f"python -m {package} " in line]
    assert lines
    for line in lines:
        parser().parse_args(shlex.split(line)[3:])


ELSEWHERE = "sim figures", "sim serve", "socket://"
"""What takes minutes, or two terminals: tests/test_sim_figures_make.py, tests/test_sim_backends_link_board.py."""


def test_commands_run(tmp_path, monkeypatch):
    """In this order, with the scene that stands above them; ``part.msh`` is anybody's mesh."""
    monkeypatch.chdir(tmp_path)
    (text,) = blocks("toml")
    Path("my.toml").write_text(text)
    assert golden.main(shlex.split("mesh disc --radius 50 --edge 10 --out part.msh")) == 0
    lines = re.findall(r"^`?\.venv/bin/python -m ([^`\n]+)", README, re.MULTILINE)
    chosen = [line for line in lines if not any(word in line for word in ELSEWHERE)]
    for line in chosen:
        package, *arguments = shlex.split(line)
        assert {"sim": sim, "golden": golden, "hw": cli}[package].main(arguments) == 0, line
    assert len(chosen) >= 7 and Path("build/my-page/index.html").exists() and Path("build/my-run/vtu/run.pvd").exists()


def test_make_targets_exist():
    named = set(re.findall(r"(?:`|^)make ([a-z]+)", README, re.MULTILINE))
    assert {"test", "verilog", "lint", "help"} <= named <= documents.targets()


def test_files_and_folders_exist():
    named = re.findall(r"`((?:golden|hw|sim|scenes|tests|docs)/[\w./]*)`", README)
    for path in named + re.findall(r"\]\(([\w./]+)\)", README):
        assert (ROOT / path).exists(), path
