"""The compiled integer model computes what the NumPy model does, bit for bit."""

import numpy as np
import pytest
from integer_objects import MATERIALS, irregular, pressed, random_image

import sim.backends.native
from golden.datapath.formats import Formats
from golden.datapath.machine import Machine
from sim.backends.native import NativeMachine, compiled
from sim.backends.native_source import sources
from sim.encode.encode import encode


def assert_same(a, b):
    for name in ("x", "v", "ratio", "force"):
        assert np.array_equal(getattr(a, name), getattr(b, name)), name
    assert a.faults == b.faults


@pytest.mark.parametrize("nodes", [(4, 3), (3, 3, 2)], ids=["2-D", "3-D"])
@pytest.mark.parametrize("material", MATERIALS)
def test_every_preset_gives_the_same_bits(material, nodes, rng):
    loaded = encode(pressed(irregular(nodes, rng), MATERIALS[material], 30))
    machines = Machine(loaded.image), NativeMachine(loaded.image)
    for phase in loaded.scene.phases:
        velocity = loaded.start(phase, machines[0].v)
        for machine in machines:
            machine.restart(velocity)
            machine.step(phase.steps)
        assert_same(*machines)
    assert not machines[0].faults
    assert (machines[0].x != loaded.image.x).any()


def random_images(seed):
    for number in range(6):
        yield random_image(np.random.default_rng([seed, number]), true_inverse=number % 2 == 0)


def test_random_images_give_the_same_bits_and_the_same_faults(seed):
    faults = set()
    for image in random_images(seed):
        machines = Machine(image), NativeMachine(image)
        for _ in range(4):
            for machine in machines:
                machine.step()
            assert_same(*machines)
        faults |= set(machines[0].faults)
    # d is at most 1 a component, every mantissa and 1 / l less: these can't leave their formats, whatever tables hold
    assert faults == set(compiled(Formats())[1]) - {"direction", "inverse length", "mantissa"}


@pytest.mark.parametrize(("operand", "state"), [(12, 24), (22, 44)])
def test_other_word_lengths_give_the_same_bits(operand, state, rng):
    image = random_image(rng, Formats(operand, state), edges=30)
    machines = Machine(image), NativeMachine(image)
    for machine in machines:
        machine.step(3)
    assert_same(*machines)


def test_the_order_of_edges_changes_nothing(rng):
    mesh = irregular((4, 4), rng)
    edges = len(mesh.edges)
    scene = pressed(mesh, tuple(MATERIALS.values()), 60, edge_material=rng.integers(5, size=edges))
    results = []
    for order in (None, rng.permutation(edges), rng.permutation(edges)):
        loaded = encode(scene, edge_order=order)
        machine = NativeMachine(loaded.image)
        for phase in scene.phases:
            machine.restart(loaded.start(phase, machine.v))
            machine.step(phase.steps)
        results.append((machine.x, machine.v, machine.force, machine.ratio[np.argsort(loaded.edge_order)]))
    for other in results[1:]:
        assert all(np.array_equal(a, b) for a, b in zip(results[0], other, strict=True))


def test_a_run_in_pieces_is_the_same_run(rng, monkeypatch):
    image = random_image(rng)
    whole, pieces, chunks = NativeMachine(image), NativeMachine(image), NativeMachine(image)
    whole.step(10)
    for steps in (1, 0, 4, 5):
        pieces.step(steps)
    monkeypatch.setattr(
        sim.backends.native, "CHUNK", 3 * 4 * len(image.edges)
    )  # three steps between two chances to interrupt
    chunks.step(10)
    assert_same(whole, pieces)
    assert_same(whole, chunks)


def test_a_step_leaves_the_arrays_before_it_alone(rng):
    image = random_image(rng)
    machine = NativeMachine(image)
    before = machine.x, machine.v, machine.ratio, machine.force
    copies = [state.copy() for state in before]
    machine.step()
    assert all(np.array_equal(state, copy) for state, copy in zip(before, copies, strict=True))
    assert (machine.x != before[0]).any()
    assert (image.x == copies[0]).all()


def test_restart_takes_up_velocities_and_the_changed_image(rng):
    first, second = random_image(rng), random_image(rng)
    machines = Machine(first), NativeMachine(first)
    for machine in machines:
        machine.step()
    first.load, first.inverse_mass, first.materials = second.load, second.inverse_mass, second.materials
    for machine in machines:
        machine.restart(second.v)
        machine.step()
    assert_same(*machines)


@pytest.mark.parametrize(
    ("what", "spoil", "message"),
    [
        ("edges", lambda image: image.edges.__setitem__((3, 0), 12), "edges must be 0 to 11, not 0 to 12"),
        ("edges", lambda image: image.edges.__setitem__((3, 0), -1), "edges must be 0 to 11, not -1 to 11"),
        ("material", lambda image: image.edge_material.__setitem__(0, 8), "edge_material must be 0 to 7, not 0 to 8"),
        ("table", lambda image: image.materials[0].update(table=3), "table must be 0 to 2, not "),
    ],
)
def test_an_image_that_points_outside_itself_is_refused(what, spoil, message, rng):
    image = random_image(rng)
    spoil(image)
    with pytest.raises(IndexError, match=f"^{message}"):
        NativeMachine(image)


def test_arrays_of_another_shape_are_refused(rng):
    machine = NativeMachine(random_image(rng))
    machine.v = machine.v[:-1]
    with pytest.raises(ValueError, match="shape"):
        machine.step()


def test_numbers_wider_than_an_integer_of_the_machine_are_refused(monkeypatch):
    monkeypatch.setattr("sim.backends.native_source.WIDEST", 52)
    with pytest.raises(ValueError, match=r"^weighted_add must have at most 52 bits, not 53: take shorter state words$"):
        sources(Formats())
