"""The result of a run: its frames in SI units and, from integer backends, in the circuit's integers."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from golden.physics.trajectory import Trajectory
from sim.encode.units import Units


@dataclass(frozen=True, eq=False)
class Raw:
    """The circuit's own integers at F frames, nodes and edges in the scene's order: two runs must agree on them."""

    x: np.ndarray  # (F, N, 3) int64, golden.datapath.formats position
    v: np.ndarray  # (F, N, 3) int64, velocity
    ratio: np.ndarray  # (F, E) int64, ratio

    def same(self, other: Raw) -> bool:
        """Return whether every bit of every frame is the same."""
        pairs = (self.x, other.x), (self.v, other.v), (self.ratio, other.ratio)
        return all(np.array_equal(ours, theirs) for ours, theirs in pairs)


@dataclass(frozen=True, eq=False)
class Result:
    """The result of a run. ``raw``, ``units`` and ``faults`` belong to integer backends, ``cycles``, ``lanes`` and
    ``updates`` to a circuit.

    A fault counts the saturations of a quantity, by the quantity's name; a circuit only tells 1 for "at least one".
    """

    backend: str
    trajectory: Trajectory
    seconds: float
    raw: Raw | None = None
    units: Units | None = None
    faults: dict[str, int] = field(default_factory=dict)
    cycles: int | None = None
    lanes: int | None = None
    updates: int | None = None

    @property
    def saturations(self) -> int:
        """Number of saturations of all quantities."""
        return sum(self.faults.values())
