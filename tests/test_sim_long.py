"""A million steps of the integer model: objects at rest stay at rest, and rounding errors add up as predicted."""

import numpy as np
import pytest
from golden_objects import phase, scene
from integer_objects import DT, MATERIALS, irregular, pressed

from sim.backends.native import NativeMachine
from sim.encode.encode import encode

MILLION = 1_000_000


def at_rest(materials, rng, nodes=(3, 3)):
    mesh = irregular(nodes, rng)
    edge_material = rng.permutation(np.arange(len(mesh.edges)) % len(materials))
    return encode(scene(mesh, materials, DT, [phase(mesh, 1)], mass=0.002, edge_material=edge_material)).image


def assert_at_rest(machine, image):
    assert np.array_equal(machine.x, image.x)
    assert not machine.v.any() and not machine.force.any()
    assert np.array_equal(machine.ratio, image.ratio)
    assert not machine.faults


def test_a_free_object_of_all_presets_at_rest_does_not_move_by_a_bit_in_a_million_steps(rng):
    image = at_rest(tuple(MATERIALS.values()), rng)
    machine = NativeMachine(image)
    machine.step(MILLION)
    assert_at_rest(machine, image)


@pytest.mark.parametrize("nodes", [(4, 3), (3, 2, 2)], ids=["2-D", "3-D"])
@pytest.mark.parametrize("material", MATERIALS)
def test_a_step_leaves_any_object_at_rest_as_it_is(material, nodes, rng):
    """The state is the same after one step, and therefore after any number."""
    for _ in range(30):
        image = at_rest((MATERIALS[material],), rng, nodes)
        machine = NativeMachine(image)
        machine.step()
        assert_at_rest(machine, image)


def test_an_object_in_uniform_motion_keeps_its_velocity_to_the_bit(rng):
    image = at_rest(tuple(MATERIALS.values()), rng)
    image.v = np.tile(rng.integers(-1000, 1000, 3), (len(image.x), 1))
    machine = NativeMachine(image)
    machine.step(MILLION // 10)
    assert np.array_equal(machine.v, image.v)
    moved = machine.x - image.x
    assert (moved == moved[0]).all() and moved.any()


@pytest.mark.parametrize("material", ["plastic", "plastic-force"])
def test_a_pressed_and_released_plastic_block_stays_for_a_million_steps(material, rng):
    """The object is held until its inner nodes are at rest: their last velocities round to no displacement."""
    block = pressed(irregular((3, 3), rng), MATERIALS[material], 3000, depth=0.1)
    loaded = encode(block)
    machine = NativeMachine(loaded.image)
    for part in block.phases:
        machine.restart(loaded.start(part, machine.v))
        machine.step(part.steps)
    pressed_shape = loaded.positions(machine.x)
    machine.step(MILLION)
    moved = np.abs(loaded.positions(machine.x) - pressed_shape).max() / block.size
    print(f"moved {moved:.2g} of its size, {machine.faults=}")
    assert np.abs(pressed_shape - block.mesh.points).max() > 0.09 * block.size
    assert moved < 1e-6
    assert not machine.faults


def test_the_ratio_of_a_loaded_viscoelastic_block_does_not_drift(rng):
    mesh = irregular((4, 4), rng)
    low, high = mesh.points[:, 1] < 0.006, mesh.points[:, 1] > 0.03
    part = phase(mesh, 100_000, low, load=(high, [0.02, -0.05]))
    loaded = encode(scene(mesh, MATERIALS["viscoelastic"], DT, [part], mass=0.002, gravity=[0.0, -9.81]))
    machine = NativeMachine(loaded.image)
    machine.step(part.steps // 2)
    middle = loaded.positions(machine.x)
    machine.step(part.steps // 2)
    assert np.array_equal(machine.ratio, loaded.image.ratio)
    assert not machine.faults
    size = loaded.scene.size
    assert np.abs(middle - mesh.points).max() > 0.02 * size  # the load does something
    assert np.abs(loaded.positions(machine.x) - middle).max() < 1e-5 * size


def mean_velocity(machine):
    """Return (3,) the sum of the velocities in LSBs, weighted with the machine's own masses."""
    mass = np.ldexp(1.0, machine.image.inverse_mass["shift"]) / machine.image.inverse_mass["value"]
    return mass @ machine.v / mass.sum()


@pytest.mark.parametrize("material", MATERIALS)
def test_a_free_object_keeps_its_momentum_but_for_the_rounding_of_velocities(material, rng):
    """Pulls are opposite integers, and a force that fits a mantissa is not rounded. Two roundings of a velocity are
    left, of half a last place at most: by the inverse mass, and of the sum of four slopes by six. That sum modulo six
    is 3, a tie, one time in six, and ties go up: 1/12 of a last place a step where the slopes are many and various."""
    mesh = irregular((3, 3), rng)
    everywhere, masses = slice(None), rng.uniform(0.001, 0.003, 9)
    fastest = phase(mesh, 1, driven=(everywhere, rng.uniform(-0.05, 0.05, (9, 2))), load=(everywhere, 0.1))
    loaded = encode(scene(mesh, MATERIALS[material], DT, [fastest, phase(mesh, 1)], mass=masses))
    machine = NativeMachine(loaded.image)
    velocity = loaded.start(fastest, loaded.image.v)
    machine.restart(loaded.start(loaded.scene.phases[1], velocity >> 3))
    machine.step(10_000)  # oscillations die away: translation and rotation are left

    steps, before, position = 60_000, mean_velocity(machine), machine.x
    for _ in range(60):
        machine.step(steps // 60)
        assert np.abs(machine.force).max() < 1 << loaded.image.formats.operand - 1  # a mantissa holds it
    drift = ((mean_velocity(machine) - before) / steps)[:2]
    print(f"drift of the mean velocity a step, last places: {drift}")
    assert (machine.x != position)[:, :2].all() and not machine.faults
    assert np.abs(drift).max() <= 1 / 2 + 1 / 2 + 2**-6
    if not material.startswith("plastic"):  # whose forces, once nothing is deformed any more, are few small integers
        np.testing.assert_allclose(drift, 1 / 12, atol=0.005)
