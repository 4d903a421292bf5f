"""sim.results.cycles: properties of the cycle model alone; test_sim_meshes.py compares it with the circuit."""

import numpy as np
import pytest
from integer_objects import MATERIALS, pressed

from golden.datapath.rk4 import RK4
from golden.mesh.mesh import box, rectangle
from hw.machine.issue_register import LATENCY as ISSUE_LATENCY
from hw.machine.latency import Latencies
from hw.parameters import Parameters
from sim.encode.encode import encode
from sim.results.cycles import Wavefront, issue_times


def wavefront(nodes, lanes, updates=1, latencies=None, axes=3):
    make = rectangle if len(nodes) == 2 else box
    mesh = make(nodes, tuple(0.0125 * (n - 1) for n in nodes))
    image = encode(pressed(mesh, MATERIALS["rheological"], 30)).image
    parameters = Parameters(lanes=lanes, updates=updates, nodes=1024, axes=axes)
    return Wavefront(image, parameters, latencies), image


def test_entries_are_issued_in_order():
    assert issue_times(np.array([0, 0, 9, 0, 2]), 4).tolist() == [4, 5, 9, 10, 11]
    assert issue_times(np.array([0, 0, 9, 0, 20]), 4, 3).tolist() == [4, 7, 10, 13, 20]


@pytest.mark.parametrize(
    ("nodes", "lanes", "updates", "least"),
    [
        ((8, 8, 8), 4, 1, 0.98),
        ((4, 4, 32), 4, 1, 0.98),
        ((23, 23), 4, 2, 0.98),
        ((5, 5, 5), 4, 1, 0.95),
        ((9, 9), 4, 2, 0.60),
    ],
)
def test_lanes_reach_the_promised_occupancy(nodes, lanes, updates, least):
    model, _ = wavefront(nodes, lanes, updates)
    print(f"{nodes}: {model.per_step()} cycles a step, occupancy {model.occupancy():.4f}")
    assert least <= model.occupancy() <= 1


@pytest.mark.parametrize("lanes", [1, 2, 4, 6])
def test_a_step_takes_at_least_its_rows_its_nodes_and_its_loop(lanes):
    for nodes in ((4, 4), (9, 9), (4, 4, 4)):
        model, image = wavefront(nodes, lanes)
        rows = -(-len(image.edges) // lanes)
        loop = Latencies.of(Parameters(lanes=lanes))
        assert model.per_step() >= RK4.stages * max(rows, image.nodes, loop.edge + loop.node)
        assert 0 < np.diff(model.run(5)).max() <= model.run(1)[0]


def test_without_latencies_the_longer_list_sets_the_time_of_a_step():
    model, image = wavefront((9, 9), 1, latencies=Latencies(0, 0, 0, 0))
    assert model.per_step() == RK4.stages * len(image.edges)
    assert model.run(3)[-1] + ISSUE_LATENCY >= 3 * model.per_step()


def test_with_one_axis_at_a_time_nodes_with_few_edges_set_the_time_of_a_step():
    """Two-dimensional objects have less than three edges a node, three-dimensional ones more."""
    for nodes, longer in (((9, 9), "nodes"), ((5, 5, 5), "edges")):
        model, image = wavefront(nodes, 1, latencies=Latencies(0, 0, 0, 0), axes=1)
        most = {"nodes": 3 * image.nodes, "edges": len(image.edges)}
        assert model.per_step() == RK4.stages * most[longer] and most[longer] == max(most.values())
