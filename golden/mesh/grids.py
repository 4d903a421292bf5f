"""Points and cells of rectangular grids of triangles and box grids of tetrahedra."""

from __future__ import annotations

from math import isfinite

import numpy as np

from golden.support.errors import InputError


def rectangle(nodes, size) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (N, 2) and triangles (M, 3) of `golden.mesh.mesh.rectangle`."""
    points, corner, parity = _grid(nodes, size, 2)
    a, b, c, d = corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)
    return points, _cut(parity, [(a, b, d), (a, d, c)], [(a, b, c), (b, d, c)])


def box(nodes, size, tetrahedra: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (N, 3) and tetrahedra (M, 4) of `golden.mesh.mesh.box`."""
    if isinstance(tetrahedra, bool) or tetrahedra not in (5, 6):
        raise InputError(f"tetrahedra must be 5 or 6, not {tetrahedra!r}")
    points, corner, parity = _grid(nodes, size, 3)
    o, x, y, z = corner(0, 0, 0), corner(1, 0, 0), corner(0, 1, 0), corner(0, 0, 1)
    xy, xz, yz, xyz = corner(1, 1, 0), corner(1, 0, 1), corner(0, 1, 1), corner(1, 1, 1)
    if tetrahedra == 6:  # one for each path from o to xyz along the axes
        even = odd = [
            (o, x, xy, xyz),
            (o, x, xz, xyz),
            (o, y, xy, xyz),
            (o, y, yz, xyz),
            (o, z, xz, xyz),
            (o, z, yz, xyz),
        ]
    else:  # one in the middle, on every other corner, and one at each of the corners left
        even = [(o, xy, xz, yz), (x, o, xy, xz), (y, o, xy, yz), (z, o, xz, yz), (xyz, xy, xz, yz)]
        odd = [(x, y, z, xyz), (o, x, y, z), (xy, x, y, xyz), (xz, x, z, xyz), (yz, y, z, xyz)]
    return points, _cut(parity, even, odd)


def _grid(nodes, size, dim: int):
    """Return the points, a function from a corner's offset to that node of every grid cell, and the cells' parities.

    The first axis runs fastest in the order of the points.
    """
    if len(list(nodes)) != dim or not all(type(n) is int and n >= 2 for n in nodes):
        raise InputError(f"nodes must be {dim} whole numbers of at least 2, not {list(nodes)}")
    if len(list(size)) != dim or not all(type(s) in (int, float) and isfinite(s) and s > 0 for s in size):
        raise InputError(f"size must be {dim} finite numbers above 0, not {list(size)}")
    index = np.indices(nodes[::-1])[::-1].reshape(dim, -1)  # (dim, N), first axis fastest
    step = np.divide(size, np.array(nodes) - 1)
    stride = np.cumprod([1, *nodes[:-1]])
    last = np.array(nodes)[:, None] - 1
    first = index[:, (index < last).all(axis=0)]  # the lowest corner of each grid cell
    return index.T * step, lambda *offset: stride @ (first + np.array(offset)[:, None]), first.sum(axis=0) % 2


def _cut(parity: np.ndarray, even, odd) -> np.ndarray:
    """Return the cells of all grid cells, cut by parity, in the order of the grid cells."""
    even, odd = np.array(even), np.array(odd)  # (cells of a grid cell, corners, grid cells)
    cells = np.where(parity == 0, even, odd)
    return cells.transpose(2, 0, 1).reshape(-1, cells.shape[1])
