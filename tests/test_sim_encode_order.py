"""sim.encode.order: permutations that keep an edge close to the others of its nodes."""

import numpy as np
import pytest

from golden.mesh import mesh
from sim.encode.order import order, ranks, reach, sweeps


def ring(n, thick):
    """Return a bent strip that no axis follows."""
    strip = mesh.rectangle((n, thick), (5.0, 1.0))
    angle, radius = strip.points[:, 0], 3 + strip.points[:, 1]
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1), strip.edges


OBJECTS = {
    "block": lambda: (lambda m: (m.points, m.edges))(mesh.rectangle((9, 9), (1, 1))),
    "cube": lambda: (lambda m: (m.points, m.edges))(mesh.box((4, 4, 4), (1, 1, 1))),
    "bar": lambda: (lambda m: (m.points, m.edges))(mesh.box((3, 12, 3), (1, 4, 1))),
    "bent": lambda: ring(30, 4),
}


@pytest.mark.parametrize("name", OBJECTS)
def test_an_order_is_a_permutation_that_keeps_neighbours_close(name, rng):
    """Both are permutations; edges go by their higher node, then the lower; no sweep has a shorter reach."""
    points, edges = OBJECTS[name]()
    n, shuffle = len(points), rng.permutation(len(points))
    points, edges = points[np.argsort(shuffle)], rng.permutation(np.sort(shuffle[edges], axis=1))
    node_order, edge_order = order(points, edges)
    assert sorted(node_order) == list(range(n)) and sorted(edge_order) == list(range(len(edges)))
    low, high = np.sort(ranks(node_order)[edges[edge_order]], axis=1).T
    assert (np.diff(high * n + low) > 0).all()
    chosen = reach(np.stack([low, high], axis=1))
    assert chosen < reach(edges) / 2
    for nodes in sweeps(points, edges):
        assert sorted(nodes) == list(range(n))
        ends = np.sort(ranks(nodes)[edges], axis=1)
        assert chosen <= reach(ends[np.lexsort((ends[:, 0], ends[:, 1]))])


def test_a_sweep_along_the_grid_touches_two_of_its_lines():
    """The reach spans an edge, the rest of its line and the next line: 9 nodes with three edges to lower ones each."""
    points, edges = OBJECTS["block"]()
    node_order, edge_order = order(points, edges)
    assert reach(ranks(node_order)[edges[edge_order]]) == 28


def test_the_reach_is_the_longest_distance_between_edges_of_a_node():
    assert reach(np.array([[0, 1], [2, 3]])) == 0
    assert reach(np.array([[0, 1], [2, 3], [1, 2]])) == 2  # the first waits for the last
    assert reach(np.array([[0, 1], [1, 2], [2, 3]])) == 1
