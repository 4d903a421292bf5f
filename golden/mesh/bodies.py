"""Irregular meshes of discs, rings, cylinders, balls, beams and irregular plates: points (m) and cells."""

from __future__ import annotations

from itertools import product
from math import ceil, pi, sqrt

import numpy as np

from golden.mesh.filling import Body, fill
from golden.support.errors import InputError

MAX_NODES = 2000  # several times what a circuit holds, and made within seconds


def disc(radius: float, edge: float, seed: int = 0):
    """Return a disc around the origin."""
    _check_edge(edge, radius, "radius", pi * radius**2, 2)
    return fill(Body(_circle(radius, edge), lambda p: _length(p) - radius), edge, seed)


def ring(outer: float, inner: float, edge: float, seed: int = 0):
    """Return a disc of the radius ``outer`` around the origin with a hole of the radius ``inner``."""
    if not inner < outer:
        raise InputError(f"inner must be below outer = {outer:g}, not {inner:g}")
    _check_edge(edge, outer - inner, "width", pi * (outer**2 - inner**2), 2)
    boundary = np.concatenate([_circle(outer, edge), _circle(inner, edge)])
    return fill(Body(boundary, lambda p: np.maximum(_length(p) - outer, inner - _length(p))), edge, seed)


def irregular(radius: float, edge: float, seed: int = 0):
    """Return a plate around the origin; the seed chooses its outline, between 0.7 and 1.3 radii away."""
    _check_edge(edge, 0.7 * radius, "least radius of its outline", pi * radius**2, 2)
    waves = np.arange(2, 6)
    height = np.random.default_rng(seed).uniform(-1, 1, (2, len(waves)))
    height *= 0.3 / np.hypot(*height).sum()

    def outline(angle):
        """Return its distance from the origin, in radii, and the slope of that."""
        turns = np.multiply.outer(angle, waves)
        return (
            1 + np.cos(turns) @ height[0] + np.sin(turns) @ height[1],
            np.cos(turns) @ (waves * height[1]) - np.sin(turns) @ (waves * height[0]),
        )

    def distance(p):
        far, slope = outline(np.arctan2(p[:, 1], p[:, 0]))
        return (_length(p) - radius * far) / np.sqrt(1 + (slope / far) ** 2)

    angle = np.linspace(0, 2 * pi, 4096)
    line = radius * outline(angle)[0][:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    along = np.concatenate([[0], np.cumsum(_length(np.diff(line, axis=0)))])
    even = np.linspace(0, along[-1], _segments(along[-1], edge) + 1)[:-1]
    boundary = np.stack([np.interp(even, along, part) for part in line.T], axis=1)
    return fill(Body(boundary, distance), edge, seed)


def beam(size: list[float], edge: float, seed: int = 0):
    """Return a rectangle or a box with its lowest corner at the origin."""
    if len(size) not in (2, 3) or min(size) <= 0:
        raise InputError(f"size must be 2 or 3 numbers above 0, not {list(size)}")
    size = np.array(size, dtype=float)
    _check_edge(edge, size.min(), "shortest side", size.prod(), len(size))
    boundary = _box_surface(size, edge, seed)
    return fill(Body(boundary, lambda p: (np.abs(p - size / 2) - size / 2).max(axis=1)), edge, seed)


def ball(radius: float, edge: float, seed: int = 0):
    """Return a ball around the origin."""
    _check_edge(edge, radius, "radius", 4 / 3 * pi * radius**3, 3)
    count = ceil(4 * pi * radius**2 / (sqrt(3) / 2 * edge**2))
    turn, height = pi * (1 + sqrt(5)) * np.arange(count), 1 - (2 * np.arange(count) + 1) / count
    across = np.sqrt(1 - height**2)  # a spiral: the same area around every node
    boundary = radius * np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)
    return fill(Body(boundary, lambda p: _length(p) - radius), edge, seed)


def cylinder(radius: float, height: float, edge: float, seed: int = 0):
    """Return a cylinder that stands on the origin, its axis along z."""
    _check_edge(edge, min(radius, height), "radius and height", pi * radius**2 * height, 3)
    end, _ = disc(radius, edge, seed)
    rows = _segments(height, edge * sqrt(3) / 2)
    levels = [np.insert(end, 2, 0, axis=1), np.insert(end, 2, height, axis=1)]
    for row in range(1, rows):
        levels.append(np.insert(_circle(radius, edge, turned=row % 2 / 2), 2, height * row / rows, axis=1))

    def distance(p):
        return np.maximum(_length(p[:, :2]) - radius, np.abs(p[:, 2] - height / 2) - height / 2)

    return fill(Body(np.concatenate(levels), distance), edge, seed)


def _check_edge(edge: float, most: float, which: str, measure: float, dim: int) -> None:
    if edge > most * (1 + 1e-9):
        raise InputError(f"edge must be at most {most:g}, the {which}, not {edge:g}")
    least = (measure / MAX_NODES) ** (1 / dim)
    if edge < least:
        raise InputError(f"edge must be at least {least:.2g}, for {MAX_NODES} nodes at most, not {edge:g}")


def _segments(length: float, edge: float) -> int:
    return max(1, round(length / edge))


def _length(p: np.ndarray) -> np.ndarray:
    return np.linalg.norm(p, axis=1)


def _circle(radius: float, edge: float, turned: float = 0.0) -> np.ndarray:
    """Return nodes on a circle, rotated by ``turned`` times their distance; unrotated, one lies on each half-axis."""
    count = 4 * max(2, round(2 * pi * radius / edge / 4))
    angle = 2 * pi * (np.arange(count) + turned) / count
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _box_surface(size: np.ndarray, edge: float, seed: int) -> np.ndarray:
    """Return nodes on the corners, the edges and, in three dimensions, inside the faces of a box."""
    dim = len(size)
    parts = [np.array(list(product(*([0.0, side] for side in size))))]
    for axis, side in enumerate(size):
        count = _segments(side, edge)
        between = side * np.arange(1, count) / count
        parts += [
            np.insert(np.tile(corner, (len(between), 1)), axis, between, axis=1)
            for corner in product(*([0.0, other] for other in np.delete(size, axis)))
        ]
        if dim == 3:
            face = np.delete(size, axis)
            rim = _box_surface(face, edge, seed)
            points, _ = beam(face, edge, seed)
            parts += [np.insert(points[len(rim) :], axis, at, axis=1) for at in (0.0, side)]
    return np.concatenate(parts)


KINDS = {make.__name__: make for make in (disc, ring, cylinder, ball, beam, irregular)}
