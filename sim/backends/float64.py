"""The backend that computes in float64, with `golden.physics.model`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from golden.physics import model
from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from sim.backends.backend import Backend
from sim.backends.machine import FloatMachine


@dataclass(frozen=True, eq=False)
class Float64Machine:
    """A scene for `golden.physics.model`."""

    scene: Scene

    def simulate(self, progress: Callable[[int], object] | None = None) -> Trajectory:
        """Run all phases of the scene and return its frames."""
        return model.simulate(self.scene, progress)


@dataclass(frozen=True)
class FloatBackend(Backend):
    """The float64 model, which the others are compared with."""

    name = "float"
    words = "float64"
    summary = "float64"
    integers = False
    compared = True

    @contextmanager
    def open(self, scene: Scene) -> Iterator[FloatMachine]:
        """Give the model of a scene."""
        yield Float64Machine(scene)
