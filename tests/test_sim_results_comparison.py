"""sim.compare and sim.results.comparison: the figures of a comparison, its bounds, and many scenes at once."""

import json
from dataclasses import replace

import golden_objects as objects
import numpy as np
import pytest
from sim_objects import DT, MATERIALS, MESHES, Standin, block, in_place_of_the_circuit

from golden.support.errors import InputError
from sim.backends.registry import BACKENDS, compared_backends
from sim.backends.rtl import RtlBackend
from sim.compare import compare, complete
from sim.results import ranges
from sim.results.comparison import power, shortcomings
from sim.results.face import watched
from sim.run import run
from sim.support import batch

KEYS = [
    "scene",
    "dim",
    "force_dependent",
    "nodes",
    "edges",
    "steps",
    "dt",
    "backends",
    "lanes",
    "updates",
    "cycles",
    "cycles_per_step",
    "occupancy",
    "boards",
    "rtl_equals_fixed",
    "max_dx_rel",
    "final_dx_rel",
    "bound",
    "recovery",
    "max_da",
    "energy",
    "saturations",
    "faults",
    "ranges",
    "seconds",
]


@pytest.fixture
def circuit(monkeypatch):
    monkeypatch.setitem(BACKENDS, RtlBackend.name, in_place_of_the_circuit())


class OneBit(Standin):
    """A circuit that differs from the integer model in the last bit of one ratio, from step 5 to step 9 only."""

    done = 0

    def step(self, steps: int = 1):
        self.ratio = self.ratio.copy()
        for _ in range(steps):
            self.ratio[3] ^= self.done == 9
            super().step(1)
            self.done += 1
            self.ratio[3] ^= self.done == 5


@pytest.mark.parametrize("material", ["viscoelastic", "plastic-force"])
def test_an_entry_holds_what_the_runs_show(circuit, material):
    scene = block(material, steps=(10, 5, 10), every=5)
    result = compare(scene, lanes=2)
    entry = result.entry()
    assert list(entry) == KEYS
    json.dumps(entry, allow_nan=False)
    expected = {
        "scene": "object",
        "dim": 2,
        "nodes": 12,
        "edges": 23,
        "steps": 25,
        "dt": DT,
        "lanes": 2,
        "updates": 1,
        "cycles": 2500,
        "rtl_equals_fixed": True,
        "saturations": 0,
        "faults": {"fixed": {}, "rtl": {}},
        "backends": ["float", "fixed", "rtl"],
        "cycles_per_step": 100,
        "occupancy": 4 * 23 / 200,
        "force_dependent": scene.force_dependent,
        "bound": 5e-5 if scene.force_dependent else 1e-5,
    }
    assert {key: entry[key] for key in expected} == expected
    apart = result.circuit.trajectory.x - result.float64.trajectory.x
    largest = max(np.hypot(*node) for frame in apart for node in frame)
    assert entry["max_dx_rel"] == pytest.approx(largest / scene.size, rel=1e-12)
    assert entry["final_dx_rel"] == result.dx_rel()[-1] <= entry["max_dx_rel"]
    assert entry["energy"] == {name: values[-1] for name, values in result.energy.items()}
    assert entry["ranges"] == ranges.measure(scene, result.circuit.raw)
    assert entry["max_da"] == max(np.abs(result.circuit.trajectory.a - result.float64.trajectory.a).ravel())
    assert shortcomings(entry) == []


def test_one_bit_in_one_frame_is_a_difference(monkeypatch):
    monkeypatch.setitem(BACKENDS, RtlBackend.name, in_place_of_the_circuit(OneBit))
    entry = compare(block("viscoelastic", steps=(10, 5, 10), every=5)).entry()
    assert entry["rtl_equals_fixed"] is False
    assert shortcomings(entry) == ["the circuit's frames differ from the integer model's"]


def test_a_flag_of_the_circuit_is_a_saturation(monkeypatch):
    class Flagged(Standin):
        def step(self, steps: int = 1):
            super().step(steps)
            self.faults["velocity"] = 1

    monkeypatch.setitem(BACKENDS, RtlBackend.name, in_place_of_the_circuit(Flagged))
    entry = compare(block(steps=(5, 5, 5))).entry()
    assert entry["saturations"] == 1 and entry["faults"] == {"fixed": {}, "rtl": {"velocity": 1}}
    assert shortcomings(entry) == ["saturated: velocity"]


def test_an_existing_run_is_not_repeated(circuit):
    scene = block(steps=(10, 5, 5), every=10)
    fixed, told = run(scene, "fixed"), []
    result = complete(scene, {"fixed": fixed}, ("float",), progress=lambda doing, steps: told.append(doing))
    assert list(result.runs) == ["fixed", "float"] and result.circuit is fixed and set(told) == {"float", "ranges"}
    entry = result.entry()
    assert (entry["rtl_equals_fixed"], entry["cycles"], entry["lanes"], entry["occupancy"]) == (None,) * 4
    assert entry["max_dx_rel"] == compare(scene).entry()["max_dx_rel"] and shortcomings(entry) == []
    assert complete(scene, compare(scene).runs, compared_backends()).circuit.backend == "rtl"


def test_shortcomings_are_named():
    entry = {"rtl_equals_fixed": True, "saturations": 0, "faults": {}, "max_dx_rel": 1e-5, "bound": 1e-5}
    assert shortcomings(entry) == []
    assert shortcomings(entry | {"rtl_equals_fixed": None}) == []
    assert shortcomings(entry | {"max_dx_rel": 1.26e-5}) == ["max_dx_rel must be at most 1e-5, not 1.3e-5"]
    assert shortcomings(entry | {"max_dx_rel": float("nan")}) == ["max_dx_rel must be at most 1e-5, not nan"]
    everything = {
        "rtl_equals_fixed": False,
        "saturations": 3,
        "faults": {"fixed": {"b": 2, "a": 1}, "rtl": {"b": 1}},
        "max_dx_rel": 1,
        "bound": 5e-5,
    }
    assert shortcomings(everything) == [
        "the circuit's frames differ from the integer model's",
        "saturated: a, b",
        "max_dx_rel must be at most 5e-5, not 1e0",
    ]


@pytest.mark.parametrize("x, text", [(1e-5, "1e-5"), (1.34e-6, "1.3e-6"), (9.99e-7, "1e-6"), (0.0, "0"), (20, "2e1")])
def test_small_numbers_are_written_in_short(x, text):
    assert power(x) == text


def test_a_comparison_reports_its_progress(circuit):
    told = []
    compare(block(steps=(10, 5, 5), every=10), progress=lambda backend, steps: told.append((backend, steps)))
    assert [backend for n, (backend, _) in enumerate(told) if told[n - 1][0] != backend] == [
        *compared_backends(),
        "ranges",
    ]
    assert {(backend, steps) for backend in ("float", "fixed", "rtl") for steps in (0, 20)} <= set(told)


# the recovery that the paper's figures show: the clay stays pressed, the gel returns
@pytest.mark.parametrize(
    "material, low, high", [("plastic", -0.01, 0.05), ("viscoelastic", 0.95, 1.05), ("rheological", 0.2, 0.9)]
)
def test_the_recovery_is_that_of_the_material(material, low, high):
    scene = block(material, steps=(40, 300, 3000), every=400, mass=0.001)
    assert low <= watched(scene).recovery(scene, run(scene, "float").trajectory) <= high


def test_no_recovery_where_nothing_is_let_go():
    m = MESHES[2]
    gravity = objects.scene(m, MATERIALS["plastic"], DT, [objects.phase(m, 5, objects.bottom(m))], gravity=[0, -9.81])
    down = (objects.top(m), (0.0, -0.1))
    kept = objects.scene(m, MATERIALS["plastic"], DT, [objects.phase(m, 5, objects.bottom(m), down)])
    for scene in (gravity, kept):
        assert watched(scene).recovery(scene, run(scene, "float").trajectory) is None


@pytest.mark.parametrize("velocity, axis, direction", [((0.0, -0.1), 1, -1), ((0.2, 0.1), 0, 1)])
def test_the_driven_face_is_watched(velocity, axis, direction):
    m = MESHES[2]
    drives = None, (objects.top(m), velocity)
    phases = [objects.phase(m, 5, objects.bottom(m), drive) for drive in drives]
    scene = objects.scene(m, MATERIALS["plastic"], DT, phases, every=5)
    face, run_ = watched(scene), run(scene, "float").trajectory
    assert (face.axis, face.direction, face.pressed) == (axis, direction, True)
    assert (face.nodes == objects.top(m)).all()
    np.testing.assert_allclose(face.height(run_), run_.x[:, face.nodes, axis].sum(axis=1) / 4)
    assert face.force(run_)[-1] > 0  # it takes a force to press


def test_without_a_drive_the_top_is_watched():
    m = MESHES[3]
    for gravity, axis, direction in (([0, 0, -9.81], 2, 1), ([9.81, 0, 0], 0, -1), (None, 2, 1)):
        phases = [objects.phase(m, 400, objects.bottom(m))]
        face = watched(objects.scene(m, MATERIALS["plastic"], DT, phases, gravity=gravity))
        assert (face.axis, face.direction, face.pressed) == (axis, direction, False)
        along = direction * m.points[:, axis]
        assert (face.nodes == (along == along.max())).all()


def named(name):
    return replace(block(steps=(5, 5, 5)), name=name)


def count(scene, progress):
    """Return a result from a process of its own."""
    if progress:
        progress("float", scene.steps)
    return scene.name, len(scene.mesh.points)


def refuse(scene, progress):
    raise InputError(f"{scene.name} must be another, not this one")


@pytest.mark.parametrize("cores", [1, 2])
def test_a_batch_keeps_the_order_and_reports_its_progress(cores, monkeypatch):
    monkeypatch.setattr(batch, "cores", lambda: cores)
    told, names = [], ["a", "b", "c"]
    results = batch.over_scenes(count, [named(name) for name in names], lambda *args: told.append(args))
    assert results == [(name, 12) for name in names]
    assert sorted(told) == [(0, "float", 15), (1, "float", 15), (2, "float", 15)]
    assert batch.over_scenes(count, [named("a"), named("b")]) == [("a", 12), ("b", 12)]


@pytest.mark.parametrize("cores", [1, 2])
def test_a_batch_ends_with_the_first_error(cores, monkeypatch):
    monkeypatch.setattr(batch, "cores", lambda: cores)
    with pytest.raises(InputError, match=r"^a must be another, not this one$"):
        batch.over_scenes(refuse, [named("a"), named("a")])
