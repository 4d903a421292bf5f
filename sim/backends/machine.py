"""The interfaces of the machines that backends open: in the circuit's integers, and in float64."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from golden.datapath.memory_image import MemoryImage
from golden.physics.trajectory import Trajectory

if TYPE_CHECKING:
    from hw.parameters import Parameters


@runtime_checkable
class Machine(Protocol):
    """An object in the circuit's integers, between two steps.

    `golden.datapath.machine.Machine` computes it with NumPy, `sim.backends.native.NativeMachine` with compiled C++,
    `sim.backends.circuit.CircuitMachine` in a circuit. Nodes and edges are in the circuit's order.

    Attributes
    ----------
    x, v : (N, 3) int64
        Positions and velocities.
    ratio : (E,) int64
    force : (N, 3) int64
        Edge forces and load on each node in the last stage.
    faults : Counter
        Saturations of each quantity so far, by its name.
    """

    x: np.ndarray
    v: np.ndarray
    ratio: np.ndarray
    force: np.ndarray
    faults: Counter

    def step(self, steps: int = 1) -> None:
        """Compute so many steps."""

    def restart(self, v: np.ndarray) -> None:
        """Go on with these velocities, and take up changes of the image's loads and masses."""

    def take(self, image: MemoryImage) -> None:
        """Go on with an image that differs in materials, natural lengths and ratios."""


@runtime_checkable
class ClockedMachine(Machine, Protocol):
    """A machine in a circuit, which counts its clock cycles."""

    cycles: int
    parameters: Parameters


@runtime_checkable
class FloatMachine(Protocol):
    """An object in float64."""

    def simulate(self, progress: Callable[[int], object] | None = None) -> Trajectory:
        """Run all phases of the scene and return its frames; ``progress(steps done)`` is called on the way."""
