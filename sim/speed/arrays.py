"""The arrays that `sim.speed.kernel` works on, from a scene."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from golden.physics.scene import Phase, Scene
from golden.support.errors import InputError

RATIO, BASE, TOTAL, RHO_K, RHO_K_L, RHO_C1, SLIP, LOW, HIGH = range(9)
"""Rows of ``Arrays.edge``: the ratio at the stage, before the step, the sum of its changes so far; with
rho = c2 / (c1 + c2), rho k, rho k L and rho c1, which give the pull; 1 / c2; a_min and a_max."""

LINE = 64
"""Bytes of a cache line. A line that two threads write to bounces between their cores, 0.1 us each time."""

TOGETHER = 16
"""Granularity of a thread's share, in edges or nodes: so many numbers fill one cache line, or two."""


class Arrays(NamedTuple):
    """N nodes, E edges in ascending order (i, then j), in one floating-point type; indices are unsigned.

    Rows of numbers are padded, so that each begins with a cache line.
    """

    i: np.ndarray  # (E,)
    j: np.ndarray  # (E,)
    first: np.ndarray  # (N + 1,) node n is the i of edges first[n] to first[n + 1]
    start: np.ndarray  # (N + 1,) and the j of edges where[start[n]] to where[start[n + 1]]
    where: np.ndarray  # (E,)
    edge: np.ndarray  # (9, E) see above
    gap: np.ndarray  # (2 dim, E) x[j] - x[i], v[j] - v[i]; then da/dt in row ``dim``
    pull: np.ndarray  # (dim, E) force on node i
    node: np.ndarray  # (2 dim, N) x and v at the stage
    base: np.ndarray  # (2 dim, N) before the step
    total: np.ndarray  # (2 dim, N) sum of their changes so far
    force: np.ndarray  # (dim, N) sum of the edges' pulls
    mobility: np.ndarray  # (N,) 1 / mass, 0 of held nodes
    drift: np.ndarray  # (dim, N) acceleration by gravity and loads
    time: np.ndarray  # (3,) from the start of the step to the next stage
    weight: np.ndarray  # (4,) weights of the stages' rates
    axes: tuple[int, ...]  # its length is the number of dimensions


def arrays(scene: Scene, dtype) -> Arrays:
    """Return the scene at rest. Raises `InputError` for dampers that depend on the force."""
    if scene.force_dependent:
        raise InputError(
            "materials must have linear dampers for the compiled float model, not ones that depend on the force"
        )
    mesh, dim, edges, nodes = scene.mesh, scene.dim, len(scene.mesh.edges), len(scene.mesh.points)
    i, j = mesh.edges.T
    where = np.argsort(j, kind="stable")
    k, c1, a0 = scene.per_edge(lambda m: m.k), scene.per_edge(lambda m: m.c1), scene.per_edge(lambda m: m.a0)
    rho = scene.per_edge(lambda m: m.rho_sigma(0.0)[0])
    length = np.linalg.norm(mesh.points[j] - mesh.points[i], axis=1)
    edge = [
        a0,
        a0,
        0 * a0,
        rho * k,
        rho * k * a0 * length,
        rho * c1,
        1 / scene.per_edge(lambda m: m.damper.c_max),
        scene.per_edge(lambda m: m.a_min),
        scene.per_edge(lambda m: m.a_max),
    ]
    node = np.concatenate([mesh.points.T, np.zeros((dim, nodes))])
    return Arrays(
        *(
            index.astype(np.uint64)
            for index in (
                i,
                j,
                np.searchsorted(i, np.arange(nodes + 1)),
                np.searchsorted(j[where], np.arange(nodes + 1)),
                where,
            )
        ),
        *(
            rows(values, dtype)
            for values in (
                edge,
                np.zeros((2 * dim, edges)),
                np.zeros((dim, edges)),
                node,
                node,
                np.zeros((2 * dim, nodes)),
                np.zeros((dim, nodes)),
            )
        ),
        mobility=rows(np.zeros((1, nodes)), dtype)[0],
        drift=rows(np.zeros((dim, nodes)), dtype),
        time=(scene.dt * np.array([1, 1, 2]) / 2).astype(dtype),
        weight=(scene.dt * np.array([1, 2, 2, 1]) / 6).astype(dtype),
        axes=tuple(range(dim)),
    )


def rows(values, dtype) -> np.ndarray:
    """Copy (r, n) values into rows that each begin with a cache line, padded with 0."""
    count, width = np.shape(values)
    width = -(-width // TOGETHER) * TOGETHER
    size = count * width * np.dtype(dtype).itemsize
    room = np.zeros(size + LINE, np.uint8)
    begin = -room.ctypes.data % LINE
    result = room[begin : begin + size].view(dtype).reshape(count, width)
    result[:, : np.shape(values)[1]] = values
    return result


def begin(arrays: Arrays, scene: Scene, phase: Phase) -> None:
    """Put the object under a phase's constraints and loads, as `golden.physics.model.Model.begin` does."""
    dim, mass, nodes = scene.dim, scene.mass, len(scene.mass)
    arrays.mobility[:nodes] = np.where(phase.held, 0, 1 / mass)
    arrays.drift[:, :nodes] = np.where(phase.held, 0, (phase.load / mass[:, None] + scene.gravity).T)
    fixed, driven = np.flatnonzero(phase.fixed), np.flatnonzero(phase.driven)
    for state in (arrays.node, arrays.base):
        state[dim:, fixed] = 0
        state[dim:, driven] = phase.velocity[phase.driven].T


def shares(count: int, threads: int) -> np.ndarray:
    """Return (threads + 1,), the bounds of the shares of ``count`` edges or nodes."""
    bounds = np.arange(threads + 1) * count // (threads * TOGETHER) * TOGETHER
    bounds[-1] = count
    return bounds.astype(np.uint64)
