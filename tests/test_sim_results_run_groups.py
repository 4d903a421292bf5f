"""sim.results.run_groups and run_folder.load_result: runs are loaded bit by bit; folders that no run can have left, or
that don't belong together, are refused."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from sim_objects import block, in_place_of_the_circuit

from golden.support.errors import InputError
from sim.backends.registry import BACKENDS
from sim.backends.rtl import RtlBackend
from sim.results import run_folder, run_groups
from sim.run import run

SCENE = replace(block("rheological-force", steps=(10, 5, 10)), name="loaf")
SOLID = replace(block("plastic", 3, steps=(10, 5, 10)), name="brick")


def kept(folder, scene=SCENE, backend="fixed"):
    """Run a scene, keep the run in a folder and return the result."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(BACKENDS, RtlBackend.name, in_place_of_the_circuit())
        result = run(scene, backend, engine="numpy")
    folder.mkdir()
    run_folder.save(scene, result, folder)
    return result


@pytest.mark.parametrize("scene", [SCENE, SOLID], ids=lambda scene: scene.name)
@pytest.mark.parametrize("backend", ["float", "fixed", "rtl"])
def test_a_run_is_the_same_when_it_is_loaded(tmp_path, scene, backend):
    result = kept(tmp_path / "run", scene, backend)
    again, found = run_folder.load_result(tmp_path / "run")
    assert again.name == scene.name
    np.testing.assert_array_equal(found.trajectory.x, result.trajectory.x)
    assert (found.backend, found.faults, found.cycles, found.lanes, found.updates) == (
        result.backend,
        result.faults,
        result.cycles,
        result.lanes,
        result.updates,
    )
    assert found.raw is None if backend == "float" else found.raw.same(result.raw)


def summary(folder, **changes):
    said = json.loads((folder / run_folder.SUMMARY).read_text())
    (folder / run_folder.SUMMARY).write_text(json.dumps(said | changes))


def trajectory(folder, change):
    with np.load(folder / run_folder.TRAJECTORY) as archive:
        arrays = dict(archive)
    change(arrays)
    np.savez(folder / run_folder.TRAJECTORY, **arrays)


def cut(arrays):
    arrays["a"] = arrays["a"][:, 1:]


def blank(arrays):
    arrays["x"][1, 2] = np.nan


def shifted(arrays):
    arrays["x"][1] += 1e-13


@pytest.mark.parametrize(
    "spoil, reason",
    [
        (lambda folder: summary(folder, backend="gpu"), "its backend is 'gpu'"),
        (lambda folder: summary(folder, seconds="long"), "summary.json has no seconds that could be one"),
        (lambda folder: summary(folder, cycles=1.5), "summary.json has no cycles that could be one"),
        (lambda folder: trajectory(folder, cut), "a in trajectory.npz must be 8 x 23 finite numbers"),
        (lambda folder: trajectory(folder, blank), "x in trajectory.npz must be 8 x 12 x 2 finite numbers"),
        (lambda folder: trajectory(folder, shifted), "the state in trajectory.npz is not one of a circuit's integers"),
    ],
)
def test_a_folder_that_cannot_be_of_a_run_is_refused(tmp_path, spoil, reason):
    folder = tmp_path / "run"
    kept(folder)
    spoil(folder)
    message = f"RUN must be a folder as `python -m sim run` left it, not {folder}: {reason}"
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        run_folder.load_result(folder)


def test_runs_are_grouped_by_scene(tmp_path):
    for name, backend in (("a", "fixed"), ("c", "float"), ("d", "rtl")):
        kept(tmp_path / name, SCENE, backend)
    kept(tmp_path / "b", SOLID)
    (first, loaf), (second, brick) = run_groups.group_by_scene(tmp_path / name for name in "abcd")
    assert (first.name, second.name) == ("loaf", "brick")
    assert loaf == {"fixed": tmp_path / "a", "float": tmp_path / "c", "rtl": tmp_path / "d"}
    assert brick == {"fixed": tmp_path / "b"}


def refused(folders, message):
    """Check the message: "RUN must be " and ``message``, in which {a} and {b} stand for the folders."""
    message = message.format(**{folder.name: folder for folder in folders})
    message = f"RUN must be {message}"
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        run_groups.group_by_scene(folders)


def test_two_runs_of_a_scene_on_one_backend_are_refused(tmp_path):
    for name in "ab":
        kept(tmp_path / name)
    refused(
        [tmp_path / "a", tmp_path / "b"], "one of each backend for a scene, not two on fixed of 'loaf': {a} and {b}"
    )


def test_two_scenes_of_a_name_are_refused(tmp_path):
    kept(tmp_path / "a")
    kept(tmp_path / "b", replace(SCENE, mass=SCENE.mass * 1.01), "float")
    refused(
        [tmp_path / "a", tmp_path / "b"],
        "of one scene where the name is one, not of two that are called 'loaf': {a} and {b}",
    )


def test_a_scene_without_integers_is_refused(tmp_path):
    kept(tmp_path / "a", SOLID)
    kept(tmp_path / "b", SCENE, "float")
    refused([tmp_path / "a", tmp_path / "b"], "one on fixed, rtl or board for the scene 'loaf' as well, not only {b}")
