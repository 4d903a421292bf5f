"""python -m sim: mistakes are refused in one line, before anything runs."""

import json
from pathlib import Path

import pytest
from scene_text import changed, written
from test_sim_cli import QUICK, refused

from sim.__main__ import main
from sim.backends import waves


@pytest.fixture
def scene(tmp_path):
    return str(written(tmp_path, QUICK))


HELP = "(see python -m sim run --help)"


@pytest.mark.parametrize(
    "arguments, message",
    [
        ([], "the following arguments are required: COMMAND (see python -m sim --help)"),
        (
            ["walk"],
            "argument COMMAND: invalid choice: 'walk' (choose from 'run', 'compare', 'figures', 'export', 'report', "
            "'serve', 'bench') (see python -m sim --help)",
        ),
        (["run", "s.toml", "--out", "o"], f"the following arguments are required: --backend {HELP}"),
        (["run", "s.toml", "--backend", "fixed"], f"the following arguments are required: --out {HELP}"),
        (
            ["run", "s.toml", "--backend", "gpu", "--out", "o"],
            f"argument --backend: invalid choice: 'gpu' (choose from 'float', 'fixed', 'rtl', 'board') {HELP}",
        ),
        (
            ["run", "s.toml", "--backend", "rtl", "--lanes", "0", "--out", "o"],
            f"argument --lanes: must be a whole number of at least 1, not '0' {HELP}",
        ),
        (
            ["run", "s.toml", "--backend", "rtl", "--lanes", "two", "--out", "o"],
            f"argument --lanes: must be a whole number of at least 1, not 'two' {HELP}",
        ),
        (
            ["run", "s.toml", "--backend", "rtl", "--waves", "png", "--out", "o"],
            f"argument --waves: invalid choice: 'png' (choose from 'vcd', 'fst') {HELP}",
        ),
        (
            ["run", "s.toml", "--backend", "fixed", "--lanes", "2", "--out", "o"],
            "--lanes must go with --backend rtl, not fixed",
        ),
        (
            ["run", "s.toml", "--backend", "float", "--updates", "2", "--out", "o"],
            "--updates must go with --backend rtl, not float",
        ),
        (
            ["run", "s.toml", "--backend", "rtl", "--updates", "3", "--out", "o"],
            "updates must be 1 or 2, not 3",
        ),
        (["compare", "s.toml", "--lanes", "9", "--out", "o"], "lanes must be a whole number from 1 to 8, not 9"),
        (
            ["run", "s.toml", "--backend", "float", "--waves", "vcd", "--out", "o"],
            "--waves must go with --backend rtl, not float",
        ),
        (
            ["run", "absent.toml", "--backend", "float", "--out", "o"],
            "absent.toml: the scene must be a readable file: No such file or directory",
        ),
        (["compare"], "the following arguments are required: SCENE (see python -m sim compare --help)"),
        (["report"], "the following arguments are required: RUN (see python -m sim report --help)"),
    ],
)
def test_mistakes_in_the_arguments_are_one_line(arguments, message, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    refused(arguments, message, capsys)
    assert not Path("o").exists()


def test_a_mistake_in_a_scene_is_refused_before_anything_runs(scene, tmp_path, capsys):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(changed(QUICK, "dt = 1e-4", "dt = -1"))
    for arguments in (["run", str(wrong), "--backend", "fixed"], ["compare", scene, str(wrong)]):
        refused([*arguments, "--out", str(tmp_path / "out")], f"{wrong}: dt must be a number above 0, not -1", capsys)
    assert not (tmp_path / "out").exists()


def test_scenes_of_the_same_name_are_refused(scene, tmp_path, capsys):
    refused(
        ["compare", scene, scene, "--out", str(tmp_path / "out")],
        "scenes must have names of their own, not 'block' twice",
        capsys,
    )


def test_numbers_the_circuit_cannot_hold_name_the_scene(tmp_path, capsys):
    path = written(tmp_path, changed(QUICK, "velocity = [0, -0.5]", "velocity = [0, -1e3]"))
    for arguments in (["run", str(path), "--backend", "fixed"], ["compare", str(path)]):
        refused(
            [*arguments, "--out", str(tmp_path / "out")],
            f"{path}: phases[0].driven must have velocities below 500 m/s, not 1e+03: "
            "the circuit moves a node by less than a quarter of the object's size in a step",
            capsys,
        )


def test_other_peoples_folders_are_left_alone(scene, tmp_path, capsys):
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    (theirs / "summary.json").write_text("mine")
    run_ = ["run", scene, "--backend", "float", "--out", str(theirs)]
    refused(
        run_,
        f"--out must be a new folder or one of earlier results, not {theirs}, which holds other files: "
        "choose another, or add --force to write into it all the same",
        capsys,
    )
    assert (theirs / "summary.json").read_text() == "mine"
    assert main([*run_, "--force"]) == 0
    assert json.loads((theirs / "summary.json").read_text())["backend"] == "float"


def test_out_must_be_a_folder(scene, tmp_path, capsys):
    refused(
        ["run", scene, "--backend", "float", "--out", scene], f"--out must be a folder, not the file {scene}", capsys
    )
    below = f"{scene}/below"
    refused(
        ["run", scene, "--backend", "float", "--out", below],
        f"--out must be a folder that can be written, not {below}: Not a directory",
        capsys,
    )


def test_fst_without_its_libraries_is_refused_before_anything_runs(scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(waves, "found", lambda header: header == "zlib.h")
    refused(
        ["run", scene, "--backend", "rtl", "--waves", "fst", "--out", str(tmp_path / "out")],
        "waves as fst need a library that is missing: install it (Debian: apt install liblz4-dev), "
        "or take vcd, which needs none",
        capsys,
    )
    assert not (tmp_path / "out").exists()
