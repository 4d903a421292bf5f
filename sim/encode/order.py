"""The order in which the circuit works through nodes and edges: it changes the speed, never the result."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import reverse_cuthill_mckee


def order(points: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return (node order, edge order): the sweep with the shortest reach of several, edges by their higher node.

    An edge is issued again when all edges of its nodes have been summed and the nodes updated. A stage therefore takes
    as long as the circuit's loop and the longest distance in the list from an edge to the last one that shares a node
    with it (`reach`), which is the size of the sweep's front. The sweeps are the levels of reverse Cuthill-McKee,
    which follow a bent object, and one along each axis, whose planes are smaller in a straight object.

    Parameters
    ----------
    points : (N, dim) float
    edges : (E, 2) int
    """
    found = []
    for nodes in sweeps(points, edges):
        ends = np.sort(ranks(nodes)[edges], axis=1)
        by_higher_node = np.lexsort((ends[:, 0], ends[:, 1]))
        found.append((reach(ends[by_higher_node]), nodes, by_higher_node))
    return min(found, key=lambda sweep: sweep[0])[1:]


def sweeps(points: np.ndarray, edges: np.ndarray):
    """Yield orders of nodes: reverse Cuthill-McKee, then along each axis, within a plane along the next axis."""
    ones = np.ones(len(edges), np.int8)
    graph = coo_array((ones, (edges[:, 0], edges[:, 1])), shape=(len(points), len(points))).tocsr()
    yield np.asarray(reverse_cuthill_mckee(graph + graph.T, symmetric_mode=True), np.int64)
    for axis in range(points.shape[1]):
        yield np.lexsort(np.roll(points, -axis, axis=1).T[::-1])


def reach(edges: np.ndarray) -> int:
    """Return the longest distance in a list of edges from one to the last that shares a node with it."""
    positions = np.arange(len(edges))
    last = np.zeros(edges.max() + 1, np.int64)
    np.maximum.at(last, edges, positions[:, None])
    return int((last[edges].max(axis=1) - positions).max())


def ranks(order: np.ndarray) -> np.ndarray:
    """Return the rank of each entry of a permutation: its inverse."""
    inverse = np.empty_like(order)
    inverse[order] = np.arange(len(order))
    return inverse
