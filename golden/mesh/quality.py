"""Quality of triangles and tetrahedra: the radius ratio."""

from __future__ import annotations

from itertools import combinations
from math import factorial

import numpy as np


def signed_measure(corners: np.ndarray) -> np.ndarray:
    """Return the area or volume (M,) of cells with corners (M, dim + 1, dim), negative for a negative orientation."""
    sides = corners[:, 1:] - corners[:, :1]
    return np.linalg.det(sides) / factorial(sides.shape[1])


def radius_ratio(corners: np.ndarray) -> np.ndarray:
    """Return dim times the radius of the inscribed circle or sphere over the radius of the circumscribed one (M,).

    The corners are (M, dim + 1, dim). The ratio is 1 for equal sides and 0 for a flat cell, be it a sliver or a
    needle; it is negative for a negative orientation.
    """
    dim = corners.shape[2]
    measure = signed_measure(corners)
    if dim == 2:
        a, b, c = (_distance(corners, *pair) for pair in ((1, 2), (0, 2), (0, 1)))
        below = (a + b + c) * a * b * c
        factor = 16
    else:
        a, b, c = (
            _distance(corners, *pair) * _distance(corners, *other)
            for pair, other in (((0, 1), (2, 3)), ((0, 2), (1, 3)), ((0, 3), (1, 2)))
        )
        product = (a + b + c) * (a + b - c) * (a - b + c) * (b + c - a)  # (24 volume circumradius)^2
        surface = sum(_area(corners[:, face]) for face in map(list, combinations(range(4), 3)))
        below = surface * np.sqrt(np.maximum(product, 0))
        factor = 216
    above = factor * measure * np.abs(measure)
    return np.divide(above, below, out=np.zeros_like(above), where=below > 0)


def _distance(corners, i, j) -> np.ndarray:
    return np.linalg.norm(corners[:, i] - corners[:, j], axis=1)


def _area(triangles: np.ndarray) -> np.ndarray:
    """Return the area (M,) of triangles (M, 3, 3) in space."""
    sides = triangles[:, 1:] - triangles[:, :1]
    return np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2
