"""A resolved scene: an object, its materials and the phases it goes through. SI units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from golden.mesh.mesh import Mesh
from golden.physics.materials import Material


@dataclass(frozen=True, eq=False)
class Phase:
    """A stretch of time with one set of constraints and loads, for N nodes in ``dim`` dimensions.

    It starts by replacing the materials, if it brings others, without a jump in force (`golden.physics.switch`). Then
    fixed nodes get velocity 0 and driven nodes their prescribed one; a released node keeps the velocity it had. No
    node is both fixed and driven.
    """

    name: str
    steps: int
    fixed: np.ndarray  # (N,) bool
    velocity: np.ndarray  # (N, dim) m/s, of the driven nodes
    driven: np.ndarray  # (N,) bool
    load: np.ndarray  # (N, dim) N, external force on each node
    materials: tuple[Material, ...] | None = None  # of the whole object from here on; None for the same as before

    @property
    def held(self) -> np.ndarray:
        """Nodes whose motion is prescribed, fixed or driven: (N,) bool."""
        return self.fixed | self.driven


@dataclass(frozen=True, eq=False)
class Scene:
    """An object and what is done to it. `golden.scene.load.load` makes one from a file."""

    name: str
    description: str
    path: Path | None  # the file it came from
    mesh: Mesh  # N nodes, E edges
    materials: tuple[Material, ...]
    edge_material: np.ndarray  # (E,) int, index into materials
    mass: np.ndarray  # (N,) kg
    gravity: np.ndarray  # (dim,) m/s^2
    dt: float  # s
    phases: tuple[Phase, ...]
    frames: np.ndarray  # (F,) int, steps to keep: strictly increasing, with 0 and the end of every phase

    @property
    def dim(self) -> int:
        return self.mesh.dim

    @property
    def size(self) -> float:
        """Largest extent of the initial object (m)."""
        return self.mesh.size

    @property
    def steps(self) -> int:
        return sum(phase.steps for phase in self.phases)

    @property
    def end_frames(self) -> np.ndarray:
        """Index of the frame at the end of each phase: (P,) int."""
        return np.searchsorted(self.frames, np.cumsum([phase.steps for phase in self.phases]))

    @property
    def force_dependent(self) -> bool:
        """True if any edge has, at any time, a damper whose coefficient depends on the force."""
        used = np.unique(self.edge_material)
        return any(materials[m].damper.force_dependent for materials in self.material_sets for m in used)

    @property
    def material_sets(self) -> list[tuple[Material, ...]]:
        """Materials at the start, then those that phases bring."""
        return [self.materials, *(phase.materials for phase in self.phases if phase.materials)]

    def per_edge(self, parameter: Callable[[Material], float]) -> np.ndarray:
        """Return the (E,) values of a parameter of the edges' materials, such as ``lambda material: material.k``."""
        return np.array([parameter(material) for material in self.materials], dtype=float)[self.edge_material]
