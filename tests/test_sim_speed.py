"""The compiled float model gives the golden model's results, and step times are taken as described."""

import os
import re
from dataclasses import replace

import golden_objects as objects
import numpy as np
import pytest
from sim_objects import DT, MATERIALS, MESHES, block

from golden.physics import materials, stability
from golden.physics.model import Model
from golden.support.errors import InputError
from sim.speed import arrays, meshes, timing
from sim.speed.compiled import CompiledModel

DOUGH = materials.rheological("dough", 200.0, 0.5, 20.0, a_min=0.495, a_max=0.505)  # its ratio reaches the limits
MIXED = DOUGH, MATERIALS["viscoelastic"], MATERIALS["plastic"]


def differences(model, golden):
    """Return the differences of positions by the object's size, of velocities by the largest, and of ratios."""
    largest = np.abs(golden.v).max()
    return (
        np.abs(model.x - golden.x).max() / golden.scene.size,
        np.abs(model.v - golden.v).max() / largest,
        np.abs(model.a - golden.a).max(),
    )


@pytest.mark.parametrize("name", meshes.MESHES)
def test_every_mesh_of_the_benchmark_moves_as_the_golden_model(name):
    scene = meshes.scene(name)
    stability.check(scene)
    golden, single, double = Model(scene), CompiledModel(scene), CompiledModel(scene, np.float64)
    for _ in range(300):
        golden.step()
    single.step(300)
    double.step(300)
    assert np.abs(golden.x - scene.mesh.points).max() > 2e-4 * scene.size
    assert np.all(differences(double, golden) < (1e-13, 1e-11, 1e-12))
    assert np.all(differences(single, golden) < (2e-5, 5e-3, 5e-5))
    assert single.x.dtype == np.float32 and double.x.dtype == np.float64


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("dtype, allowed", [(np.float64, (1e-12, 1e-11, 1e-12)), (np.float32, (2e-5, 5e-3, 2e-4))])
def test_phases_loads_bounds_and_mixed_materials_are_those_of_the_model(dim, dtype, allowed):
    mesh = MESHES[dim]
    phases = objects.press_hold_release(mesh, np.ptp(mesh.points[:, -1]) / 10, (80, DT), 60, 60)
    load = np.zeros(mesh.points.shape)
    load[objects.top(mesh), 0] = 0.01
    phases[2] = replace(phases[2], load=load)
    scene = objects.scene(
        mesh,
        MIXED,
        DT,
        phases,
        mass=0.01 + 0.001 * (np.arange(len(mesh.points)) % 3),
        gravity=[0.3] * dim,
        edge_material=np.arange(len(mesh.edges)) % 3,
    )
    stability.check(scene)
    golden, model = Model(scene), CompiledModel(scene, dtype)
    for phase in scene.phases:
        golden.begin(phase)
        model.begin(phase)
        for _ in range(phase.steps):
            golden.step()
        model.step(phase.steps)
        assert np.all(differences(model, golden) < allowed)
        bounded = golden.a[scene.edge_material == 0]
        assert (bounded == DOUGH.a_max).any() or (bounded == DOUGH.a_min).any()


@pytest.mark.parametrize("name", ["9x9", "5x5x5"])
@pytest.mark.parametrize("threads", [2, 3])
def test_threads_compute_what_one_does_and_the_same_every_time(name, threads):
    scene = meshes.scene(name)
    one, some, again = (CompiledModel(scene, np.float64, n) for n in (1, threads, threads))
    cores = os.sched_getaffinity(0)
    for model in (one, some, again):
        model.step(100)
    assert os.sched_getaffinity(0) == cores
    for quantity in "xva":
        np.testing.assert_array_equal(getattr(some, quantity), getattr(again, quantity))
        np.testing.assert_allclose(getattr(some, quantity), getattr(one, quantity), rtol=1e-9, atol=1e-13)


@pytest.mark.parametrize("threads", [1, 2, 3, 200])
@pytest.mark.parametrize("count", [15, 81, 208])
def test_threads_share_everything_once(count, threads):
    bounds = arrays.shares(count, threads)
    assert len(bounds) == threads + 1 and bounds[0] == 0 and bounds[-1] == count
    shares = np.diff(bounds.astype(int))
    assert (shares >= 0).all() and (np.abs(shares - count / threads) < arrays.TOGETHER).all()


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int64])
def test_no_two_threads_write_to_one_cache_line(dtype):
    values = np.arange(51).reshape(3, 17)
    rows = arrays.rows(values, dtype)
    assert rows.dtype == dtype and rows.flags.c_contiguous and rows.shape == (3, 32)
    assert not [row for row in rows if row.ctypes.data % arrays.LINE]
    assert arrays.TOGETHER * rows.itemsize % arrays.LINE == 0
    np.testing.assert_array_equal(rows, np.pad(values, ((0, 0), (0, 15))))


@pytest.mark.parametrize(
    "change, message",
    [
        ({"threads": 0}, "threads must be a whole number of at least 1, not 0"),
        (
            {"scene": block("rheological-force")},
            "materials must have linear dampers for the compiled float model, not ones that depend on the force",
        ),
    ],
)
def test_arguments_that_cannot_be_used_are_refused(change, message):
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        CompiledModel(**{"scene": meshes.scene("3x3"), **change})


@pytest.mark.parametrize("name", ["9", "9x", "2x2x2x2", "-3x3", "3 x 3"])
def test_a_wrong_name_of_a_mesh_is_refused(name):
    with pytest.raises(InputError, match=f"^meshes must be numbers of nodes like 9x9 or 5x5x5, not {name!r}$"):
        meshes.scene(name)


def test_every_step_is_timed_by_itself():
    times = CompiledModel(meshes.scene("9x9")).step(50)
    assert times.shape == (50,) and (times > 100).all()


def test_the_times_of_the_software_are_complete(monkeypatch):
    monkeypatch.setattr(timing, "LAP", 40)
    told = []
    figures = timing.software(meshes.scene("9x9"), 100, told.append)
    assert told == list(figures) == list(timing.SOFTWARE)
    for program in figures.values():
        assert list(program) == ["threads", "steps", "step_us", "p999_us", "max_us", "clock_us", "running"]
        assert program["steps"] == 100 and program["threads"] >= 1
        assert 0.1 < program["step_us"] <= program["p999_us"] <= program["max_us"]
        assert 0 <= program["clock_us"] < program["step_us"]
        assert 0 < program["running"] <= 1


def test_software_is_put_back_at_its_start(monkeypatch):
    laps = []

    class Counted:
        def __init__(self, scene, threads=1):
            laps.append([])

        def step(self, steps):
            laps[-1].append(steps)
            return np.arange(steps)

    monkeypatch.setattr(timing, "LAP", 40)
    monkeypatch.setattr(timing, "CompiledModel", Counted)
    monkeypatch.setattr(timing, "_numpy", lambda scene: Counted(scene).step)
    figures = timing.software(meshes.scene("3x3"), 100)
    assert laps == [[timing.WARM, 40], [timing.WARM, 40], [timing.WARM, 20]] * 3
    taken = np.concatenate([np.arange(40), np.arange(40), np.arange(20)]) / 1000
    assert figures["numpy"]["step_us"] == np.median(taken) and figures["numpy"]["max_us"] == 0.039
