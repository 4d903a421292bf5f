"""The visible part of a mesh: all triangles of a flat one; of a solid one, the surface that faces the reader."""

from __future__ import annotations

import numpy as np

from golden.mesh.mesh import Mesh

AZIMUTH, ELEVATION = np.radians(-60), np.radians(17)
RIGHT = np.array([-np.sin(AZIMUTH), np.cos(AZIMUTH), 0])
VIEW = np.array([np.cos(ELEVATION) * np.cos(AZIMUTH), np.cos(ELEVATION) * np.sin(AZIMUTH), np.sin(ELEVATION)])
UP = np.cross(VIEW, RIGHT)
LIGHT = np.array([0.2, -0.6, 0.77])  # of length 1, from the front and above


def projected(x: np.ndarray) -> np.ndarray:
    """Project (..., 2) or (..., 3) to (..., 2), right and up in the picture: solids without perspective."""
    return x if x.shape[-1] == 2 else np.stack([x @ RIGHT, x @ UP], axis=-1)


def surface(mesh: Mesh) -> np.ndarray:
    """Return (S, 3), the triangles of a flat mesh or the faces of a single tetrahedron each, counter-clockwise from
    outside."""
    if mesh.dim == 2:
        return mesh.cells
    faces = np.concatenate([mesh.cells[:, face] for face in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])
    return faces[once(np.sort(faces, axis=1))]


def visible(x: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return (V, 3), the faces towards the reader from back to front, and (V,), how much light they get."""
    if x.shape[1] == 2:
        return faces, np.ones(len(faces))
    a, b, c = (x[faces[:, corner]] for corner in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    front = np.flatnonzero(normal @ VIEW > 0)
    front = front[np.argsort(((a + b + c) @ VIEW)[front], kind="stable")]
    return faces[front], np.clip(normal[front] @ LIGHT, 0, 1)


def outline(mesh: Mesh) -> np.ndarray:
    """Return (B, 2, dim), the border of a flat mesh; of a solid, the visible edges of its bounding box."""
    if mesh.dim == 2:
        sides = np.sort(np.concatenate([mesh.cells[:, pair] for pair in ((0, 1), (1, 2), (0, 2))]), axis=1)
        return mesh.points[sides[once(sides)]]
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    corner = [np.where([bit & 1, bit & 2, bit & 4], high, low) for bit in range(8)]
    hidden = min(range(8), key=lambda bit: corner[bit] @ VIEW)
    pairs = [(p, p | 1 << axis) for p in range(8) for axis in range(3) if not p >> axis & 1]
    return np.array([(corner[p], corner[q]) for p, q in pairs if hidden not in (p, q)])


def once(rows: np.ndarray) -> np.ndarray:
    """Return the indices of the rows that occur once."""
    _, first, count = np.unique(rows, axis=0, return_index=True, return_counts=True)
    return first[count == 1]
