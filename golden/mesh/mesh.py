"""Meshes of triangles (2-D) or tetrahedra (3-D), with every edge once, checked."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import isfinite

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from golden.mesh import bodies, grids
from golden.mesh import files as meshfile
from golden.mesh.quality import radius_ratio, signed_measure
from golden.support.errors import InputError

COINCIDENT = 1e-6  # of the object's size: points nearer to each other than this are one
FLAT = 1e-12  # a cell smaller than this part of its longest edge to the power of dim has no area or volume


@dataclass(frozen=True, eq=False)
class Mesh:
    """Points (N, dim) in m; cells (M, dim + 1) and edges (E, 2) of node indices.

    Every edge occurs once, with i < j, in ascending order; nodes keep the order they were given in. Raises
    `InputError` when a point or an edge cannot belong to an object. Build one with `from_cells`, `rectangle`,
    `box`, `filled` or `read`.
    """

    points: np.ndarray
    cells: np.ndarray
    edges: np.ndarray

    def __post_init__(self):
        n = len(self.points)
        _check_points(self.points)
        _check_indices("edges", self.edges, n)
        i, j = self.edges.T
        if (i >= j).any() or (np.diff(i * n + j) <= 0).any():
            raise InputError("edges must be pairs i < j in ascending order, each given once")
        isolated = np.setdiff1d(np.arange(n), self.edges)
        if len(isolated):
            raise InputError(
                f"points must all belong to a cell, but point {isolated[0]} does not: remove it "
                f"({len(isolated)} of {n} are isolated)"
            )
        if pairs := KDTree(self.points).query_pairs(COINCIDENT * self.size):
            i, j = min(pairs)
            raise InputError(
                f"points must all differ, but {i} and {j} are at the same place: "
                "merge them (an edge of zero length has no direction)"
            )

    @property
    def dim(self) -> int:
        return self.points.shape[1]

    @property
    def size(self) -> float:
        """Largest extent of the bounding box (m)."""
        return float(np.ptp(self.points, axis=0).max())

    def measure(self) -> np.ndarray:
        """Return the area (m^2) or volume (m^3) of each cell (M,)."""
        return np.abs(signed_measure(self.points[self.cells]))

    def quality(self) -> np.ndarray:
        """Return the radius ratio of each cell (M,), 1 for equal sides to 0 for a flat one: `golden.mesh.quality`."""
        return np.abs(radius_ratio(self.points[self.cells]))

    def lengths(self) -> np.ndarray:
        """Return the length of each edge (E,) in m."""
        return np.linalg.norm(self.points[self.edges[:, 1]] - self.points[self.edges[:, 0]], axis=1)

    def cell_edges(self) -> np.ndarray:
        """Return the indices of each cell's edges (M, 3 or 6)."""
        count = len(self.points)
        number = self.edges @ [count, 1]  # ascending, because the edges are in order
        pairs = np.sort(self.cells[:, list(combinations(range(self.cells.shape[1]), 2))], axis=2)
        return np.searchsorted(number, pairs @ [count, 1])

    def lumped_mass(self, density) -> np.ndarray:
        """Return the nodes' masses (N,) in kg, sharing each cell's; ``density`` (one or (M,)) in kg/m^2 or kg/m^3."""
        corners = self.cells.shape[1]
        share = np.repeat(density * self.measure() / corners, corners)
        return np.bincount(self.cells.ravel(), share, len(self.points))

    def components(self) -> tuple[int, np.ndarray]:
        """Return the number of parts that no edge joins, and the index of each node's part (N,)."""
        n = len(self.points)
        adjacency = coo_array((np.ones(len(self.edges)), tuple(self.edges.T)), shape=(n, n))
        return connected_components(adjacency, directed=False)


def from_cells(points, cells) -> Mesh:
    """Return the mesh of the given triangles or tetrahedra; those of negative orientation are reordered.

    Raises `InputError` for a node index out of range, a cell given twice or without area or volume, more than two
    cells at a side, and as `Mesh` does.
    """
    points, cells = np.array(points, dtype=float), np.array(cells, dtype=np.int64)
    _check_points(points)
    _check_indices("cells", cells, len(points))
    if pair := _duplicate(np.sort(cells, axis=1)):
        raise InputError(f"cells must all differ, but cells {pair[0]} and {pair[1]} have the same nodes: remove one")
    pairs = list(combinations(range(cells.shape[1]), 2))
    corners = points[cells]
    longest = np.max([np.linalg.norm(corners[:, b] - corners[:, a], axis=1) for a, b in pairs], axis=0)
    signed = signed_measure(corners)
    for cell in np.flatnonzero(np.abs(signed) <= FLAT * longest ** points.shape[1]):
        measure = "an area" if points.shape[1] == 2 else "a volume"
        raise InputError(f"cells must all have {measure}, unlike cell {cell} (points {cells[cell].tolist()})")
    cells[signed < 0, -2:] = cells[signed < 0, :-3:-1]
    edges = np.sort(np.concatenate([cells[:, pair] for pair in pairs]), axis=1)
    mesh = Mesh(points, cells, np.unique(edges, axis=0))
    _check_sides(cells)  # last: points that are twice there have a message of their own
    return mesh


def rectangle(nodes, size) -> Mesh:
    """Return a grid of (nx, ny) nodes on [0, width] x [0, height] (m), x fastest.

    The diagonals alternate like the squares of a chessboard, so that an even number of cells is its own mirror
    image. Raises `InputError` for fewer than 2 nodes a side or a size that is not positive.
    """
    return from_cells(*grids.rectangle(nodes, size))


def box(nodes, size, tetrahedra: int = 5) -> Mesh:
    """Return a grid of (nx, ny, nz) nodes on [0, x] x [0, y] x [0, z] (m), x fastest, of 5 or 6 tetrahedra a cell.

    Five: one in the middle and four at the corners, neighbours mirrored so that their faces match. Six:
    around the same diagonal in every cell. Raises `InputError` as `rectangle` does, and for another number of
    tetrahedra.
    """
    return from_cells(*grids.box(nodes, size, tetrahedra))


def filled(kind: str, **parameters) -> Mesh:
    """Return an irregular mesh of one of `golden.mesh.bodies.KINDS`, with that function's parameters and errors."""
    return from_cells(*bodies.KINDS[kind](**parameters))


def read(path, scale: float = 1.0) -> Mesh:
    """Return the mesh of a file of triangles or tetrahedra that meshio reads; ``scale`` is the file's unit in m.

    The boundary of tetrahedra (triangles, lines, vertices, as Gmsh writes them) is ignored, and so are the lines
    and vertices of triangles, which must lie in one plane of constant z. Raises `InputError`
    for a file that is missing, unreadable or holds anything else, and as `from_cells` does.
    """
    if type(scale) not in (int, float) or not isfinite(scale) or scale <= 0:
        raise InputError(f"scale must be a finite number above 0, not {scale!r}")
    points, cells = meshfile.read(path)
    return from_cells(points * scale, cells)


def _check_sides(cells: np.ndarray) -> None:
    """Refuse a side of more than two cells: they overlap, and their mass would count twice."""
    sides = np.sort(np.concatenate([np.delete(cells, n, axis=1) for n in range(cells.shape[1])]), axis=1)
    found, count = np.unique(sides, axis=0, return_counts=True)
    if (many := np.flatnonzero(count > 2)).size:
        kind = "an edge" if cells.shape[1] == 3 else "a face"
        raise InputError(
            f"cells must meet two at {kind}, but {count[many[0]]} have the points "
            f"{found[many[0]].tolist()}: remove those that overlap"
        )


def _check_points(points: np.ndarray) -> None:
    if points.ndim != 2 or points.shape[1] not in (2, 3) or not np.isfinite(points).all():
        raise InputError("points must be finite coordinates in 2 or 3 dimensions")


def _check_indices(name: str, indices: np.ndarray, n: int) -> None:
    if indices.size == 0:
        raise InputError(f"{name} must not be empty")
    outside = indices[(indices < 0) | (indices >= n)]
    if outside.size:
        raise InputError(f"{name} must be made of the points 0 to {n - 1}, not {outside[0]}")


def _duplicate(rows: np.ndarray) -> tuple[int, int] | None:
    """Return the indices of two equal rows, if there are any."""
    order = np.lexsort(rows.T)
    same = np.flatnonzero((rows[order[1:]] == rows[order[:-1]]).all(axis=1))
    return (int(order[same[0]]), int(order[same[0] + 1])) if len(same) else None
