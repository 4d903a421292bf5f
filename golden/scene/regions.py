"""Regions of an object in a scene file: a box, a plane, a ball, or a list of nodes."""

from __future__ import annotations

import numpy as np
from msgspec import Struct
from msgspec.structs import asdict

from golden.mesh.mesh import Mesh
from golden.support.errors import InputError

TOLERANCE = 1e-6  # of the object's size: how far outside a box or a ball or off a plane a point still counts


class Extent(Struct, forbid_unknown_fields=True):
    """Corners of a box with its sides along the axes (m)."""

    min: list[float]
    max: list[float]


class Plane(Struct, forbid_unknown_fields=True):
    """Points whose coordinate along ``axis`` is within ``tolerance`` (m) of ``at`` (m)."""

    axis: str
    at: float
    tolerance: float | None = None


class Ball(Struct, forbid_unknown_fields=True):
    """Points at most ``radius`` (m) away from ``center`` (m): in two dimensions a disc."""

    center: list[float]
    radius: float


class Region(Struct, forbid_unknown_fields=True, kw_only=True):
    """Exactly one of a box, a plane, a ball and a list of nodes. Points on the border belong to it."""

    box: Extent | None = None
    plane: Plane | None = None
    ball: Ball | None = None
    nodes: list[int] | None = None


KINDS = "box", "plane", "ball", "nodes"


def select_nodes(region: Region, mesh: Mesh, path: str) -> np.ndarray:
    """Return the mask (N,) of the nodes in the region. ``path`` is the region's key in the file.

    Raises `InputError` when the region is not one of the kinds, doesn't fit the mesh, or is empty.
    """
    _exactly_one(region, path)
    if region.nodes is not None:
        selected = _listed(region.nodes, len(mesh.points), f"{path}.nodes")
    else:
        selected = _inside(region, mesh.points, mesh.size, path)
    return _not_empty(selected, "node", mesh, path)


def select_cells(region: Region, mesh: Mesh, path: str) -> np.ndarray:
    """Return the mask (M,) of the elements with their centroid or, for a list of nodes, all their nodes in the region.

    Raises `InputError` as `select_nodes` does.
    """
    _exactly_one(region, path)
    if region.nodes is not None:
        selected = _listed(region.nodes, len(mesh.points), f"{path}.nodes")[mesh.cells].all(axis=1)
    else:
        selected = _inside(region, mesh.points[mesh.cells].mean(axis=1), mesh.size, path)
    return _not_empty(selected, "element", mesh, path)


def vector(values: list[float], dim: int, path: str) -> np.ndarray:
    """Return the components as an array (dim,). Raises `InputError` for another number of them."""
    if len(values) != dim:
        raise InputError(f"{path} must have {dim} components, as the mesh does, not {len(values)}")
    return np.array(values, dtype=float)


def _exactly_one(region: Region, path: str) -> None:
    given = [kind for kind, value in asdict(region).items() if kind in KINDS and value is not None]
    if len(given) != 1:
        raise InputError(f"{path} must have one of {', '.join(KINDS)}, not {' and '.join(given) or 'none'}")


def _listed(nodes: list[int], count: int, path: str) -> np.ndarray:
    for index, node in enumerate(nodes):
        if not 0 <= node < count:
            raise InputError(f"{path}[{index}] must be a node from 0 to {count - 1}, not {node}")
    selected = np.zeros(count, dtype=bool)
    selected[nodes] = True
    return selected


def _inside(region: Region, points: np.ndarray, size: float, path: str) -> np.ndarray:
    dim = points.shape[1]
    if region.plane is not None:
        axes, tolerance = "xyz"[:dim], region.plane.tolerance
        if region.plane.axis not in tuple(axes):
            raise InputError(f"{path}.plane.axis must be one of {', '.join(axes)}, not {region.plane.axis!r}")
        if tolerance is None:
            tolerance = TOLERANCE * size
        if tolerance < 0:
            raise InputError(f"{path}.plane.tolerance must be a number of at least 0, not {tolerance}")
        return np.abs(points[:, axes.index(region.plane.axis)] - region.plane.at) <= tolerance
    if region.ball is not None:
        if region.ball.radius <= 0:
            raise InputError(f"{path}.ball.radius must be a number above 0, not {region.ball.radius}")
        center = vector(region.ball.center, dim, f"{path}.ball.center")
        return np.linalg.norm(points - center, axis=1) <= region.ball.radius + TOLERANCE * size
    low = vector(region.box.min, dim, f"{path}.box.min")
    high = vector(region.box.max, dim, f"{path}.box.max")
    if (low > high).any():
        raise InputError(f"{path}.box.max must be at least {region.box.min} everywhere, not {region.box.max}")
    return ((points >= low - TOLERANCE * size) & (points <= high + TOLERANCE * size)).all(axis=1)


def _not_empty(selected: np.ndarray, what: str, mesh: Mesh, path: str) -> np.ndarray:
    if not selected.any():
        low, high = mesh.points.min(axis=0).tolist(), mesh.points.max(axis=0).tolist()
        raise InputError(f"{path} must hold at least one {what}, not none: the object reaches from {low} to {high}")
    return selected
