"""sim.results.run_folder: the folder of a run holds all that is needed to have the run again."""

from dataclasses import astuple
from math import inf

import meshio
import numpy as np
import pytest
from scene_text import GEL, MESH, SCENE, TWO, changed, written

from golden.mesh.mesh import rectangle
from golden.scene.load import load
from golden.support.errors import InputError
from sim.__main__ import main
from sim.results import run_folder
from sim.run import run


@pytest.fixture
def kept(tmp_path):
    """Return the folder of a run of a scene with a mesh file and two materials; both files are gone."""
    grid = rectangle((3, 3), (200.0, 100.0))
    meshio.write_points_cells(tmp_path / "part.vtu", np.pad(grid.points, ((0, 0), (0, 1))), [("triangle", grid.cells)])
    text = changed(SCENE, MESH, 'mesh = { kind = "file", file = "part.vtu", scale = 1e-3 }')
    path = written(tmp_path, changed(text, GEL, TWO))
    scene = load(path)
    assert main(["run", str(path), "--backend", "float", "--out", str(tmp_path / "run")]) == 0
    path.unlink()
    (tmp_path / "part.vtu").unlink()
    return tmp_path / "run", scene


def test_a_run_is_loaded_again_from_its_folder_alone(kept):
    folder, before = kept
    scene, summary, trajectory = run_folder.load(folder)
    assert scene.path == folder / "scene.npz"
    assert (scene.name, scene.description, scene.dt) == (before.name, before.description, before.dt)
    assert scene.materials == before.materials and scene.materials[0].damper.c_max == inf
    for name in ("points", "cells", "edges"):
        assert np.array_equal(getattr(scene.mesh, name), getattr(before.mesh, name)), name
    for name in ("edge_material", "mass", "gravity", "frames"):
        assert np.array_equal(getattr(scene, name), getattr(before, name)), name
    assert [(p.name, p.steps) for p in scene.phases] == [(p.name, p.steps) for p in before.phases]
    for ours, theirs in zip(scene.phases, before.phases, strict=True):
        for name in ("fixed", "velocity", "driven", "load"):
            assert np.array_equal(getattr(ours, name), getattr(theirs, name)), name
    assert (summary["scene"], summary["backend"], summary["edges"]) == ("block", "float", len(before.mesh.edges))
    assert type(scene.phases[0].steps) is int and type(astuple(scene.materials[1])[1]) is float
    again = run(scene, "float").trajectory
    for name in ("t", "x", "v", "a", "reaction", "edges"):
        assert np.array_equal(getattr(again, name), getattr(trajectory, name)), name


@pytest.mark.parametrize("missing", ["scene.npz", "trajectory.npz", "summary.json"])
def test_a_folder_that_is_no_run_is_refused(kept, missing):
    folder, _ = kept
    (folder / missing).unlink()
    refused(folder, f"RUN must be a folder that `python -m sim run` left, not {folder}: it has no {missing}")


def test_a_missing_folder_is_refused(tmp_path):
    refused(
        tmp_path / "x",
        f"RUN must be a folder that `python -m sim run` left, not {tmp_path / 'x'}: it has no summary.json",
    )


@pytest.mark.parametrize(
    ("name", "text", "error"),
    [
        ("scene.npz", b"PK\x03\x04 no more", "BadZipFile"),
        ("trajectory.npz", b"", "EOFError"),
        ("summary.json", b"{", "JSONDecodeError"),
        ("summary.json", b"3", "TypeError"),
    ],
)
def test_a_damaged_file_is_named(kept, name, text, error):
    folder, _ = kept
    (folder / name).write_bytes(text)
    refused(folder, f"{folder / name} must be as `python -m sim run` wrote it: it cannot be read ({error})")


def test_an_archive_of_something_else_is_named(kept):
    folder, _ = kept
    (folder / "scene.npz").write_bytes((folder / "trajectory.npz").read_bytes())
    refused(folder, f"{folder / 'scene.npz'} must be as `python -m sim run` wrote it: it cannot be read (KeyError)")


@pytest.mark.parametrize(
    ("old", "new"), [("dt = 1e-4", "dt = 5e-5"), ("nodes = [3, 3]", "nodes = [3, 5]"), ('"block"', '"other"')]
)
def test_files_of_two_runs_are_refused(tmp_path, old, new):
    for name, text in (("one", SCENE), ("two", changed(SCENE, old, new))):
        assert main(["run", str(written(tmp_path, text)), "--backend", "float", "--out", str(tmp_path / name)]) == 0
    folder = tmp_path / "one"
    (folder / "scene.npz").write_bytes((tmp_path / "two" / "scene.npz").read_bytes())
    refused(
        folder,
        f"RUN must be a folder with the files of one run, not {folder}: "
        "scene.npz, trajectory.npz and summary.json differ in what they are of",
    )


def test_a_summary_says_that_its_run_is_complete(kept, monkeypatch):
    folder, scene = kept
    monkeypatch.setattr(run_folder, "write_text", None)
    with pytest.raises(TypeError):
        run_folder.save(scene, run(scene, "float"), folder)
    assert not (folder / "summary.json").exists()


def refused(folder, message):
    with pytest.raises(InputError) as error:
        run_folder.load(folder)
    assert str(error.value) == message
