"""sim.run: one interface to float64, integer model and circuit; the frames that it keeps, and its refusals."""

from pathlib import Path

import golden_objects as objects
import numpy as np
import pytest
from sim_objects import DT, MATERIALS, MESHES, block, in_place_of_the_circuit

from golden.datapath.formats import Formats
from golden.datapath.machine import Machine
from golden.physics import materials
from golden.support.errors import InputError, InternalError
from sim.backends.fixed import ENGINES
from sim.backends.registry import BACKENDS
from sim.backends.rtl import RtlBackend
from sim.backends.waves import found
from sim.results.comparison import BOUND
from sim.results.result import Raw
from sim.run import CHECKS, checked_steps, run


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("material", MATERIALS)
def test_fixed_follows_float(material, dim):
    """Positions within the issue's figure; the rest within 1e-3 of its largest."""
    scene = block(material, dim)
    exact, fixed = (run(scene, backend).trajectory for backend in ("float", "fixed"))
    assert np.linalg.norm(fixed.x - exact.x, axis=2).max() / scene.size <= BOUND[scene.force_dependent]
    assert np.abs(fixed.a - exact.a).max() <= 1e-4
    assert np.abs(fixed.v - exact.v).max() <= 1e-3 * np.abs(exact.v).max()
    assert np.abs(fixed.reaction - exact.reaction)[1:].max() <= 1e-3 * np.abs(exact.reaction).max()


@pytest.mark.parametrize("material", ["rheological", "plastic-force"])
def test_native_is_the_numpy_model(material):
    scene = block(material, 3, steps=(10, 5, 5), every=3)
    native, reference = (run(scene, "fixed", engine=engine) for engine in ENGINES)
    assert native.raw.same(reference.raw)
    assert native.faults == reference.faults
    np.testing.assert_array_equal(native.trajectory.reaction, reference.trajectory.reaction)


def test_frames_are_kept_at_the_steps_asked_for():
    scene = block(steps=(10, 4, 6), every=7)
    result = run(scene, "fixed")
    kept = result.trajectory
    assert scene.frames.tolist() == [0, 7, 10, 14, 20]
    np.testing.assert_array_equal(kept.t, scene.frames * DT)
    assert kept.x.shape == kept.v.shape == kept.reaction.shape == (5, 12, 2)
    assert kept.a.shape == (5, len(kept.edges))
    np.testing.assert_array_equal(kept.edges, scene.mesh.edges)
    np.testing.assert_allclose(kept.x[0], scene.mesh.points, atol=1e-9 * scene.size)
    np.testing.assert_allclose(kept.v[0], scene.phases[0].velocity, rtol=1e-6)


def test_raw_frames_are_the_trajectory_in_the_scenes_order():
    scene = block(steps=(10, 4, 6), every=7)
    result, formats = run(scene, "fixed"), Formats()
    x = np.ldexp(result.raw.x[:, :, :2].astype(float), -formats.position.frac_bits)
    np.testing.assert_array_equal(x * result.units.size + result.units.centre, result.trajectory.x)
    v = np.ldexp(result.raw.v[:, :, :2].astype(float), -formats.velocity.frac_bits)
    np.testing.assert_array_equal(v * result.units.velocity, result.trajectory.v)
    np.testing.assert_array_equal(
        np.ldexp(result.raw.ratio.astype(float), -formats.ratio.frac_bits), result.trajectory.a
    )


def test_same_means_every_bit(rng):
    one = Raw(*(rng.integers(-9, 9, shape) for shape in ((4, 3, 3), (4, 3, 3), (4, 5))))
    assert one.same(Raw(one.x.copy(), one.v.copy(), one.ratio.copy()))
    for name in ("x", "v", "ratio"):
        other = {part: getattr(one, part).copy() for part in ("x", "v", "ratio")}
        other[name].flat[-1] ^= 1
        assert not one.same(Raw(**other))
    assert not one.same(Raw(one.x[:-1], one.v, one.ratio))


def test_held_nodes_move_as_prescribed():
    scene = block(steps=(40, 20, 30))
    raw, (press, hold, _) = run(scene, "fixed").raw, scene.phases
    assert (raw.x[:, press.fixed] == raw.x[0, press.fixed]).all()
    per_step = (raw.x[1, press.driven] - raw.x[0, press.driven]) / scene.frames[1]
    end, rest = np.searchsorted(scene.frames, [press.steps, press.steps + hold.steps])
    assert (raw.x[end, press.driven] - raw.x[0, press.driven] == per_step * press.steps).all()
    assert (raw.x[rest, press.driven] == raw.x[end, press.driven]).all()


def test_reactions_are_those_of_held_nodes():
    """None before the first step; afterwards 0 on free nodes; in the end they carry the weight."""
    m = MESHES[2]
    scene = objects.scene(
        m,
        materials.viscoelastic("gel", 500.0, 2.0),
        DT,
        [objects.phase(m, 3000, objects.bottom(m))],
        mass=0.01,
        gravity=[0, -9.81],
        every=1000,
    )
    reaction, held = run(scene, "fixed").trajectory.reaction, scene.phases[0].held
    assert np.isnan(reaction[0, held]).all()
    assert (reaction[0, ~held] == 0).all() and (reaction[1:, ~held] == 0).all()
    assert np.isfinite(reaction[1:]).all()
    np.testing.assert_allclose(reaction[-1].sum(axis=0), [0, scene.mass.sum() * 9.81], atol=2e-3)


@pytest.mark.parametrize("dim", [2, 3])
def test_any_order_of_edges_gives_the_same_bits(dim, rng):
    scene = block("rheological-force", dim)
    usual = run(scene, "fixed")
    for _ in range(3):
        shuffled = run(scene, "fixed", edge_order=rng.permutation(len(scene.mesh.edges)))
        assert shuffled.raw.same(usual.raw)
        np.testing.assert_array_equal(shuffled.trajectory.a, usual.trajectory.a)


def test_a_saturation_is_counted_by_name():
    m = MESHES[2]
    scene = objects.scene(
        m,
        MATERIALS["plastic"],
        DT,
        [objects.phase(m, 60, objects.bottom(m), load=(objects.top(m), (1e4, 0)))],
        mass=0.01,
    )
    fixed = run(scene, "fixed")
    assert fixed.faults.keys() & {"velocity", "displacement", "position", "accumulator"}
    assert fixed.saturations == sum(fixed.faults.values()) > 0
    assert run(block(), "fixed").faults == {} == run(block(), "float").faults


def test_the_circuit_is_run_like_the_integer_model(monkeypatch, tmp_path):
    circuit = in_place_of_the_circuit()
    monkeypatch.setitem(BACKENDS, RtlBackend.name, circuit)
    scene = block(steps=(10, 5, 5))
    fixed = run(scene, "fixed")
    rtl = run(scene, "rtl", lanes=3, updates=2, waves=tmp_path / "waves.vcd")
    assert circuit.asked == [(3, 2, tmp_path / "waves.vcd")]
    assert (rtl.cycles, rtl.lanes, rtl.updates) == (2000, 3, 2)
    assert (fixed.cycles, fixed.lanes, fixed.updates) == (None, None, None)
    assert rtl.raw.same(fixed.raw)


def test_a_link_is_closed_whatever_happens():
    class Link:
        closed = False

        def close(self):
            self.closed = True

    link = Link()
    with pytest.raises(InputError):
        run(block(), "board", link=link, edge_order=[0, 1])
    assert link.closed


class Wrong(Machine):
    """A machine with one wrong bit in a quantity from step 15 on."""

    done = 0

    def step(self, steps: int = 1):
        super().step(steps)
        self.done += steps
        if self.done >= 15:
            if self.quantity == "faults":
                self.faults["position"] += 1
            else:
                getattr(self, self.quantity).flat[0] ^= 1


@pytest.mark.parametrize("quantity", ["x", "v", "ratio", "force", "faults"])
def test_a_wrong_compiled_model_is_found_out(quantity, monkeypatch):
    from sim.backends import native

    monkeypatch.setattr(Wrong, "quantity", quantity, raising=False)
    monkeypatch.setattr(native, "NativeMachine", Wrong)
    with pytest.raises(InternalError) as caught:
        run(block(steps=(10, 8, 4), every=5), "fixed")
    assert str(caught.value) == f"the compiled integer model and the NumPy model differ in {quantity} after step 15"


@pytest.mark.parametrize("every", [1, 7, 30])
def test_enough_steps_are_checked(every):
    scene = block(steps=(40, 20, 30), every=every)
    checked = checked_steps(scene)
    assert len(checked) >= min(CHECKS, len(scene.frames) - 1)
    assert checked >= {40, 60, 90} and checked <= set(scene.frames.tolist()) - {0}


@pytest.mark.parametrize("backend", ["float", "fixed"])
def test_progress_is_reported_every_so_often(backend):
    told = []
    run(block(steps=(250, 20, 30), every=400), backend, progress=told.append)
    assert told == sorted(told) and told[-1] == 300
    assert 200 in told and {250, 270} <= set(told)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"backend": "gpu"}, "backend must be one of float, fixed, rtl, board, not 'gpu'"),
        ({"backend": "board"}, "link must be given for the backend board"),
        ({"backend": "rtl", "link": object()}, "link must go with the backend board, not rtl"),
        ({"backend": "fixed", "engine": "fast"}, "engine must be one of native, numpy, not 'fast'"),
        ({"backend": "rtl", "lanes": 0}, "lanes must be a whole number from 1 to 8, not 0"),
        ({"backend": "rtl", "lanes": 2.0}, "lanes must be a whole number from 1 to 8, not 2.0"),
        ({"backend": "rtl", "updates": 3}, "updates must be 1 or 2, not 3"),
        (
            {"backend": "fixed", "waves": "w.fst"},
            "waves must go with the backend rtl, not fixed",
        ),
        ({"backend": "rtl", "waves": Path("w.png")}, "waves must be a file ending in .vcd or .fst, not w.png"),
        ({"backend": "fixed", "edge_order": [0, 1]}, "edge_order must be a permutation of 0 to 22"),
        ({"backend": "fixed", "edge_order": [0] * 23}, "edge_order must be a permutation of 0 to 22"),
    ],
)
def test_arguments_that_cannot_be_used_are_refused(arguments, message):
    scene = block()
    assert len(scene.mesh.edges) == 23
    with pytest.raises(InputError) as caught:
        run(scene, **arguments)
    assert str(caught.value) == message


def test_headers_are_found_by_the_compiler(monkeypatch):
    assert found("vector") and not found("no_such_header.h")
    monkeypatch.setenv("PATH", "")
    assert found("no_such_header.h")  # without a compiler, that is what is reported
