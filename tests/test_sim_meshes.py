"""Random meshes of every kind in circuits of every shape: the integer model's bits, the cycle model's cycles."""

import numpy as np
import pytest
from integer_objects import MATERIALS, SPACING, irregular, pressed
from rtl_objects import STATE, circuit, fan, renumbered, rtl_machine

from golden.mesh.mesh import Mesh, rectangle
from hw.machine.latency import Latencies
from hw.parameters import Parameters
from sim.backends.native import NativeMachine
from sim.backends.rtl import BUILD
from sim.encode.encode import encode
from sim.results.cycles import Wavefront, cycles_per_step
from sim.speed import meshes
from sim.speed.meshes import MESHES

STEPS = 20
CIRCUITS = [(lanes, updates, axes) for axes in (3, 1) for lanes in (1, 2, 4, 6) for updates in (1, 2)]


def graded(rng) -> Mesh:
    """Return a rectangle whose cells grow from one corner to the other."""
    nodes = tuple(int(n) for n in rng.integers(3, 9, 2))
    grid = rectangle(nodes, tuple(SPACING * (n - 1) for n in nodes))
    size = grid.points.max(axis=0)
    return Mesh((grid.points / size) ** 1.5 * size, grid.cells, grid.edges)


def disconnected(rng) -> Mesh:
    """Return two to four blocks side by side."""
    parts = [irregular(tuple(int(n) for n in rng.integers(2, 5, 2)), rng) for _ in range(rng.integers(2, 5))]
    starts = np.cumsum([0] + [len(part.points) for part in parts])
    points = [part.points + [0.08 * k, 0] for k, part in enumerate(parts)]
    cells, edges = (
        np.concatenate([getattr(part, name) + start for part, start in zip(parts, starts, strict=False)])
        for name in ("cells", "edges")
    )
    return Mesh(np.concatenate(points), cells, edges)


KINDS = {
    "2-D": lambda rng: irregular(tuple(int(n) for n in rng.integers(2, 10, 2)), rng),
    "3-D": lambda rng: irregular(tuple(int(n) for n in rng.integers(2, 6, 3)), rng),
    "graded": graded,
    "star": lambda rng: fan(int(rng.integers(3, 31))),
    "disconnected": disconnected,
}
ORDERS = {
    "fast": lambda one, rng: encode(one),
    "reversed": lambda one, rng: encode(one, edge_order=encode(one).edge_order[::-1]),
    "any edges": lambda one, rng: encode(one, edge_order=rng.permutation(len(one.mesh.edges))),
    "any nodes": lambda one, rng: renumbered(encode(one), rng.permutation(len(one.mesh.points))),
}


def image(rng, number):
    """Return an encoded object in motion, of all materials, in one of the orders."""
    kind, order = list(KINDS)[number % len(KINDS)], list(ORDERS)[number // len(KINDS) % len(ORDERS)]
    mesh = KINDS[kind](rng)
    edge_material = rng.integers(len(MATERIALS), size=len(mesh.edges))
    one = pressed(mesh, tuple(MATERIALS.values()), 300, edge_material=edge_material)
    print(f"mesh {number}: {kind}, {len(mesh.points)} nodes, {len(mesh.edges)} edges, {order}")
    return ORDERS[order](one, rng).image


def check(numbers, shape, seed):
    parameters = circuit(*shape)
    for number in numbers:
        object_ = image(np.random.default_rng([seed, number]), number)
        model, cycles = NativeMachine(object_), Wavefront(object_, parameters).run(STEPS)
        machine = rtl_machine(object_, parameters=parameters, folder=BUILD)
        try:
            for steps in (1, STEPS):
                before = machine.cycles
                model.step(steps)
                machine.step(steps)
                assert machine.cycles - before == cycles[steps - 1], f"mesh {number}"
                for name in STATE:
                    assert np.array_equal(getattr(machine, name), getattr(model, name)), f"mesh {number}: {name}"
            assert set(machine.faults) == set(model.faults)
        finally:
            machine.close()


def test_some_meshes_take_the_cycles_of_the_model(seed):
    check(range(20), (2, 1, 3), seed)


@pytest.mark.campaign
@pytest.mark.parametrize("shape", CIRCUITS)
def test_three_hundred_meshes_take_the_cycles_of_the_model(shape, seed):
    """Forty objects in each circuit, all different."""
    first = 40 * CIRCUITS.index(shape)
    check(range(first, first + 40), shape, seed)


@pytest.mark.campaign
@pytest.mark.parametrize("updates", [1, 2])
@pytest.mark.parametrize("name", MESHES)
def test_the_benchmarks_meshes_take_the_cycles_of_the_model(name, updates):
    scene = meshes.scene(name)
    parameters = Parameters(lanes=4, updates=updates, nodes=1024)
    machine = rtl_machine(encode(scene).image, parameters=parameters, folder=BUILD)
    try:
        runs = []
        for steps in (20, 21):
            before = machine.cycles
            machine.step(steps)
            runs.append(machine.cycles - before)
    finally:
        machine.close()
    assert runs[1] - runs[0] == cycles_per_step(scene, 4, updates)


@pytest.mark.parametrize("shape", CIRCUITS)
def test_all_steps_take_the_same_time(shape, seed):
    """`Wavefront.per_step` needs steps of equal length; no proof says that all lists have them, so many are tried."""
    parameters = circuit(*shape)
    latencies = Latencies.of(parameters)
    for number in range(20):
        object_ = image(np.random.default_rng([seed, number]), number)
        assert Wavefront(object_, parameters, latencies).per_step() > 0
