"""A scene as the arrays that `sim.speed.kernel` works on."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from golden.errors import InputError
from golden.problem import Phase, Scene

RATIO, BASE, TOTAL, RHO_K, RHO_K_L, RHO_C1, SLIP, LOW, HIGH = range(9)
"""Rows of ``Arrays.edge``: the ratio at the stage, before the step, the sum of its changes so far; with
rho = c2 / (c1 + c2), rho k, rho k L and rho c1, which give the pull; 1 / c2; a_min and a_max."""


class Arrays(NamedTuple):
    """N nodes, E edges in ascending order (i, then j), in one floating-point type; indices are unsigned."""

    i: np.ndarray  # (E,)
    j: np.ndarray  # (E,)
    first: np.ndarray  # (N + 1,) node n is the i of edges first[n] to first[n + 1]
    start: np.ndarray  # (N + 1,) and the j of edges where[start[n]] to where[start[n + 1]]
    where: np.ndarray  # (E,)
    edge: np.ndarray  # (9, E) see above
    gap: np.ndarray  # (2 dim, E) x[j] - x[i], v[j] - v[i]; then da/dt in row `dim`
    pull: np.ndarray  # (dim, E) force on node i
    node: np.ndarray  # (2 dim, N) x and v at the stage
    base: np.ndarray  # (2 dim, N) before the step
    total: np.ndarray  # (2 dim, N) sum of their changes so far
    force: np.ndarray  # (dim, N) sum of the edges' pulls
    mobility: np.ndarray  # (N,) 1 / mass, 0 of held nodes
    drift: np.ndarray  # (dim, N) acceleration by gravity and loads
    time: np.ndarray  # (3,) from the step's begin to the next stage
    weight: np.ndarray  # (4,) what a stage's rates count for
    axes: tuple[int, ...]  # its length is the number of dimensions


def arrays(scene: Scene, dtype) -> Arrays:
    """The scene at rest. Raises `InputError` for dampers that depend on the force."""
    if scene.force_dependent:
        raise InputError("materials must have linear dampers for the compiled float model, "
                         "not ones that depend on the force")
    mesh, dim, edges, nodes = scene.mesh, scene.dim, len(scene.mesh.edges), len(scene.mesh.points)
    i, j = mesh.edges.T
    where = np.argsort(j, kind="stable")
    k, c1, c2, a0 = (scene.per_edge(name) for name in ("k", "c1", "c_max", "a0"))
    rho = 1 / (1 + c1 / c2)
    length = np.linalg.norm(mesh.points[j] - mesh.points[i], axis=1)
    edge = [a0, a0, 0 * a0, rho * k, rho * k * a0 * length, rho * c1, 1 / c2,
            scene.per_edge("a_min"), scene.per_edge("a_max")]
    node = np.concatenate([mesh.points.T, np.zeros((dim, nodes))])
    return Arrays(
        *(index.astype(np.uint64) for index in (
            i, j, np.searchsorted(i, np.arange(nodes + 1)), np.searchsorted(j[where], np.arange(nodes + 1)), where)),
        *(values.astype(dtype) for values in (
            np.array(edge), np.zeros((2 * dim, edges)), np.zeros((dim, edges)),
            node, node, np.zeros_like(node), np.zeros((dim, nodes)), np.zeros(nodes), np.zeros((dim, nodes)),
            scene.dt * np.array([1, 1, 2]) / 2, scene.dt * np.array([1, 2, 2, 1]) / 6)),
        axes=tuple(range(dim)))


def begin(arrays: Arrays, scene: Scene, phase: Phase) -> None:
    """Put the object under a phase's constraints and loads, as `golden.model.Model.begin` does."""
    dim, mass = scene.dim, scene.mass
    arrays.mobility[:] = np.where(phase.held, 0, 1 / mass)
    arrays.drift[:] = np.where(phase.held, 0, (phase.load / mass[:, None] + scene.gravity).T)
    for state in (arrays.node, arrays.base):
        state[dim:, phase.fixed] = 0
        state[dim:, phase.driven] = phase.velocity[phase.driven].T


def shares(arrays: Arrays, threads: int) -> tuple[np.ndarray, np.ndarray]:
    """(threads + 1,) bounds of the edges and of the nodes that each thread works on: edges go with their node i."""
    edges = len(arrays.i)
    nodes = np.searchsorted(arrays.first, np.arange(threads + 1) * edges / threads).astype(np.uint64)
    nodes[-1] = len(arrays.mobility)
    return arrays.first[nodes], nodes
