"""The order in which the circuit works: it changes the speed, never the result."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import reverse_cuthill_mckee


def order(points: np.ndarray, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(node order, edge order): the shortest of several sweeps over the object, edges by their higher node.

    An edge goes again when the last edges of its nodes have been summed and the nodes updated. A stage therefore takes
    as long as the circuit's loop and the longest way in the list from an edge to the last one of its nodes (`reach`);
    a sweep's is what its front touches. Swept are the levels of reverse Cuthill-McKee, which follow a bent object, and
    each of the axes, whose planes are smaller in a straight one.

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
    """Orders of nodes: along the axes what is on one plane goes by the next axis."""
    ones = np.ones(len(edges), np.int8)
    graph = coo_array((ones, (edges[:, 0], edges[:, 1])), shape=(len(points), len(points))).tocsr()
    yield np.asarray(reverse_cuthill_mckee(graph + graph.T, symmetric_mode=True), np.int64)
    for axis in range(points.shape[1]):
        yield np.lexsort(np.roll(points, -axis, axis=1).T[::-1])


def reach(edges: np.ndarray) -> int:
    """The longest way in a list of edges from one to the last that shares a node with it."""
    places = np.arange(len(edges))
    last = np.zeros(edges.max() + 1, np.int64)
    np.maximum.at(last, edges, places[:, None])
    return int((last[edges].max(axis=1) - places).max())


def ranks(order: np.ndarray) -> np.ndarray:
    inverse = np.empty_like(order)
    inverse[order] = np.arange(len(order))
    return inverse
