"""Fill a body, given by its boundary nodes, with irregular cells: Delaunay, relaxed, without slivers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay

from golden.mesh.quality import radius_ratio, signed_measure
from golden.support.errors import InputError

WORST = {2: 0.5, 3: 0.3}
"""Smallest radius ratio that is accepted, by dimension."""
AIM = {2: 0.6, 3: 0.4}  # elements below this are improved
ROUNDS = 12  # of relaxing: most of the gain is there after five
ATTEMPTS = 8  # to reach `WORST`, each with other random numbers
CLEARANCE = 0.6  # of the edge: how far inner nodes begin from the boundary
JITTER = 0.15  # of the edge: how far they begin from a lattice's points
FLAT = 0.25  # a cell with a smaller radius ratio and all corners on the boundary is removed if it lies outermost


@dataclass(frozen=True, eq=False)
class Body:
    """A body to fill."""

    boundary: np.ndarray  # (B, dim) m, its nodes
    distance: Callable[[np.ndarray], np.ndarray]  # (P,) m from the boundary to points (P, dim), negative inside


def fill(body: Body, edge: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points (N, dim), the boundary's first, and cells (M, dim + 1) of edges about as long as ``edge`` (m).

    The same seed gives the same mesh. Raises `InputError` when some element stays below `WORST`.
    """
    dim = body.boundary.shape[1]
    for attempt in range(ATTEMPTS):
        rng = np.random.default_rng([seed, attempt])
        points = _initial_points(body, edge, rng)
        points, cells = _relax(points, body)
        _improve(points, cells, len(body.boundary), edge, rng)
        worst = radius_ratio(points[cells]).min() if len(np.unique(cells)) == len(points) else 0.0
        if worst >= WORST[dim]:
            return points, cells
    raise InputError(
        f"edge must leave elements with a radius ratio of at least {WORST[dim]}, not {worst:.2g}: "
        f"choose a smaller one than {edge:g}, or another seed"
    )


def _initial_points(body: Body, edge: float, rng) -> np.ndarray:
    """Return the boundary's nodes, and those of a lattice of good cells inside, each moved a little."""
    low, high = body.boundary.min(axis=0), body.boundary.max(axis=0)
    dim = len(low)
    # rows of equal triangles; or a grid with the centres of its cubes, whose Delaunay cells are all alike
    step = edge * (np.array([1, np.sqrt(3)]) if dim == 2 else np.full(3, 2 / np.sqrt(3)))
    counts = np.ceil((high - low) / step).astype(int) + 1
    grid = np.indices(counts).reshape(dim, -1).T
    points = low + (np.concatenate([grid, grid + 0.5]) - rng.random(dim)) * step
    points += rng.uniform(-JITTER, JITTER, points.shape) * edge
    return np.concatenate([body.boundary, points[body.distance(points) < -CLEARANCE * edge]])


def _relax(points: np.ndarray, body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Return the best of some rounds, in each of which inner nodes move to the middle of the cells around them."""
    best = -1.0, points, np.empty((0, 0), dtype=int)
    inner = slice(len(body.boundary), None)
    for _ in range(ROUNDS):
        cells = _cells(points, body)
        corners = points[cells]
        if (worst := radius_ratio(corners).min(initial=1.0)) > best[0] and len(cells):
            best = worst, points, cells
        weight = np.repeat(signed_measure(corners), cells.shape[1])
        middle = np.repeat(corners.mean(axis=1), cells.shape[1], axis=0)
        total = np.bincount(cells.ravel(), weight, len(points))
        mean = np.stack([np.bincount(cells.ravel(), weight * part, len(points)) for part in middle.T], axis=1)
        points = points.copy()
        points[inner] = mean[inner] / total[inner, None]
    return best[1:]


def _cells(points: np.ndarray, body: Body) -> np.ndarray:
    """Return the Delaunay cells inside the body, all of positive orientation, without flat ones at the boundary."""
    cells = Delaunay(points).simplices.astype(np.int64)
    cells = cells[body.distance(points[cells].mean(axis=1)) < 0]
    swap = signed_measure(points[cells]) < 0
    cells[swap, -2:] = cells[swap, :-3:-1]
    while True:
        flat = (cells < len(body.boundary)).all(axis=1) & (radius_ratio(points[cells]) < FLAT)
        flat[flat] = _outer_sides(cells)[flat] >= points.shape[1] - 1
        if not flat.any():
            return cells
        cells = cells[~flat]


def _outer_sides(cells: np.ndarray) -> np.ndarray:
    """Return how many of a cell's sides belong to no other cell (M,)."""
    corners = cells.shape[1]
    sides = np.concatenate([np.delete(cells, corner, axis=1) for corner in range(corners)])
    _, which, count = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True)
    return (count[which.ravel()] == 1).reshape(corners, -1).sum(axis=0)


def _improve(points: np.ndarray, cells: np.ndarray, fixed: int, edge: float, rng) -> None:
    """Move inner nodes of bad cells, a little and at random, where that makes the worst cell around them better.

    This removes the few slivers that relaxing leaves in 3-D. ``points`` is changed in place; no cell turns over.
    """
    dim, tries, aim = points.shape[1], 100, AIM[points.shape[1]]
    for _ in range(20):
        bad = np.unique(cells[radius_ratio(points[cells]) < aim])
        if not (bad >= fixed).any():
            return
        for node in bad[bad >= fixed]:
            around = cells[(cells == node).any(axis=1)]
            corners = points[around]
            now = radius_ratio(corners).min()
            moves = rng.normal(size=(tries, dim)) * rng.random((tries, 1)) * JITTER * edge
            moved = corners + np.where((around == node)[..., None], moves[:, None, None], 0)
            then = radius_ratio(moved.reshape(-1, dim + 1, dim)).reshape(tries, -1).min(axis=1)
            if now < aim and then.max() > now:
                points[node] += moves[np.argmax(then)]
