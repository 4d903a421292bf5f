"""Objects for runs of the simulated circuit against the integer model, and the comparison."""

import dataclasses

import numpy as np
from integer_objects import MATERIALS, irregular, pressed

from golden.mesh.mesh import Mesh
from hw.parameters import Parameters
from sim.backends.circuit import CircuitMachine
from sim.backends.rtl import BUILD
from sim.backends.simulated_circuit import SimulatedCircuit
from sim.encode.order import ranks

STATE = "x", "v", "force", "ratio"


def circuit(lanes, updates=1, axes=3):
    """Return a circuit's parameters. Circuits with the same updates share a lane, which is compiled once; two lanes
    and one update are the circuit that scenes are run on."""
    return Parameters(lanes=lanes, updates=updates, axes=axes, edges=2048 * lanes)


def rtl_machine(image, *, parameters, folder=BUILD, waves=None) -> CircuitMachine:
    """Return the simulated circuit, loaded with an image."""
    return CircuitMachine(image, SimulatedCircuit(parameters, folder, waves))


def run(loaded, machine):
    """Yield the states after each phase, nodes and edges in the scene's order."""
    nodes, edges = ranks(loaded.node_order), ranks(loaded.edge_order)
    for phase in loaded.scene.phases:
        machine.restart(loaded.start(phase, machine.v))
        machine.step(phase.steps)
        yield {name: getattr(machine, name)[edges if name == "ratio" else nodes] for name in STATE}


def assert_same(ours, theirs):
    for a, b in zip(ours, theirs, strict=True):
        for name in STATE:
            assert np.array_equal(a[name], b[name]), name


def fan(spokes=30) -> Mesh:
    """Return a wheel: every edge but those of the rim meets the hub."""
    angle = np.arange(spokes) * 2 * np.pi / spokes
    rim = np.stack([np.cos(angle), np.sin(angle)], 1) * 0.04
    points = np.concatenate([[[0, 0]], rim]) + [0, 0.04]
    outer = np.arange(1, spokes + 1)
    cells = np.stack([np.zeros_like(outer), outer, np.roll(outer, -1)], 1)
    edges = np.concatenate([cells[:, :2], cells[:, 1:]])
    return Mesh(points, cells, np.unique(np.sort(edges, axis=1), axis=0))


def scene(name, rng, steps):
    if name == "fan":
        return pressed(fan(), MATERIALS["rheological"], steps)
    mesh = irregular((5, 4) if name == "2-D" else (3, 3, 3), rng)
    edge_material = rng.integers(len(MATERIALS), size=len(mesh.edges))
    return pressed(mesh, tuple(MATERIALS.values()), steps, edge_material=edge_material)


def renumbered(loaded, order):
    """Return the same object with node ``order[n]`` as its node n."""
    image = loaded.image
    mass = {name: values[order] for name, values in image.inverse_mass.items()}
    moved = {name: getattr(image, name)[order] for name in ("x", "v", "load")}
    other = dataclasses.replace(image, inverse_mass=mass, edges=ranks(order)[image.edges], **moved)
    return dataclasses.replace(loaded, image=other, node_order=loaded.node_order[order])
