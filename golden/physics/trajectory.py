"""Trajectory of a run: the state at each frame that was kept."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from golden.support.files import atomic_file


@dataclass(eq=False)
class Trajectory:
    """F frames of N nodes and E edges in ``dim`` dimensions. SI units, float64 (edges: integers).

    The reaction is the force that the support or the driving device exerts on a fixed or driven node, 0 on a
    free one. A frame at the end of a phase shows that phase: its velocities and reactions, before the next
    phase's constraints.
    """

    t: np.ndarray  # (F,) s
    x: np.ndarray  # (F, N, dim) m
    v: np.ndarray  # (F, N, dim) m/s
    a: np.ndarray  # (F, E)
    reaction: np.ndarray  # (F, N, dim) N
    edges: np.ndarray  # (E, 2)

    def save(self, path, **meta) -> None:
        """Write a NumPy archive with these arrays and ``meta`` (anything NumPy stores) beside them.

        The file appears whole or not at all. Raises `ValueError` for a ``meta`` that has the name of an array.
        """
        arrays = vars(self)
        if taken := arrays.keys() & meta.keys():
            raise ValueError(f"meta must have names of its own, not {', '.join(sorted(taken))}")
        with atomic_file(Path(path)) as file:
            np.savez_compressed(file, allow_pickle=False, **arrays, **meta)


def load(path) -> Trajectory:
    """Return the trajectory in a file that `Trajectory.save` wrote, without its ``meta``."""
    with open(path, "rb") as file, np.load(file) as archive:  # NumPy leaves a damaged file open
        names = "t", "x", "v", "a", "reaction", "edges"
        return Trajectory(*(archive[name] for name in names))
