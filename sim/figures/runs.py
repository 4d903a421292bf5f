"""The runs that the figures are drawn from: a scene on the circuit, and on float64 beside it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from golden.scene import load as scenes
from golden.support.paths import SCENES
from sim.backends.float64 import FloatBackend
from sim.figures import single_edge
from sim.results.comparison import dx_rel
from sim.results.face import Face, watched
from sim.results.result import Result
from sim.run import run

SHIPPED = SCENES
EDGE = "edge-"
"""Prefix to the name of a shipped scene: a single edge of that scene's first material."""


@dataclass(frozen=True, eq=False)
class Pair:
    """One scene and its two runs, with the same frames."""

    scene: Scene
    circuit: Result
    float64: Result

    @property
    def x(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions (F, N, dim) in m of circuit and float64."""
        return self.circuit.trajectory.x, self.float64.trajectory.x

    @property
    def trajectories(self) -> tuple[Trajectory, Trajectory]:
        return self.circuit.trajectory, self.float64.trajectory

    @property
    def face(self) -> Face:
        return watched(self.scene)

    @property
    def released(self) -> int:
        """The frame in which the last phase begins: the object as it is held, before it is let go."""
        return int(self.scene.end_frames[-2])

    def frame(self, t: float) -> int:
        """Return the frame closest to the time t (s), the last one for any later time."""
        return int(np.abs(self.circuit.trajectory.t - t).argmin())

    def difference(self) -> float:
        """Return the largest distance of a node between circuit and float64 in any frame, as a fraction of the size."""
        return float(dx_rel(self.scene, self.circuit, self.float64).max())


def load(name: str) -> Scene:
    """Return the scene of a name: one that ships, or a single edge of its material."""
    shipped = scenes.load(SHIPPED / f"{name.removeprefix(EDGE)}.toml")
    return single_edge.scene(name, shipped.materials[0]) if name.startswith(EDGE) else shipped


def pair(scene: Scene, progress=None, *, backend: str) -> Pair:
    """Run the scene on float64 and on the circuit; ``progress(backend, steps done)``."""
    float64, circuit = (
        run(scene, on, progress=progress and partial(progress, on)) for on in (FloatBackend.name, backend)
    )
    return Pair(scene, circuit, float64)
