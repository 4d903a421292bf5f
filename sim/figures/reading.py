"""The measurements that are read from the figures' data, each with the value that it is compared with."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from sim.figures import single_edge
from sim.figures.runs import EDGE, Pair
from sim.results.comparison import BOUND

RECOVERY, BULGE = 1e-3, 1e-4
"""Largest differences that pass: of bounce-back and residual; of a side's bulge over the object's size."""

SMALL = 0.01  # of a press: a smaller value is compared as a part of the press


@dataclass(frozen=True)
class Reading:
    """A quantity of the circuit's run, of float64's, and the value that it is compared with; all in ``unit``."""

    scene: str
    quantity: str
    unit: str
    circuit: float
    float64: float
    against: str  # "closed form" or "float64"
    expected: float
    scale: float  # the divisor of a difference
    bound: float  # the largest divided difference that passes
    positive: bool = False  # whether it must be above 0 as well

    @property
    def difference(self) -> float:
        """The distance of the circuit from the expected value, as a fraction of ``scale``."""
        return abs(self.circuit - self.expected) / self.scale

    @property
    def passes(self) -> bool:
        return self.difference <= self.bound and (self.circuit > 0 or not self.positive)

    def shortcoming(self) -> str:
        """The reason why it doesn't pass."""
        above = f", and above 0, not {self.circuit:.3g} {self.unit}" if self.positive else ""
        return (
            f"{self.scene}: {self.quantity} must be within {self.bound:g} of {self.against}, "
            f"not {self.difference:.3g} off{above}"
        )

    def entry(self) -> dict:
        return asdict(self) | {"difference": self.difference, "passes": self.passes}


def press(pair: Pair) -> list[Reading]:
    """Return bounce-back and residual (m): an edge's compared with the closed form, a block's with float64.

    Each difference is relative to the value itself, or to the press where the value is next to nothing (residual of
    the viscoelastic, bounce-back of the plastic).
    """
    (depth, back), (depth64, back64) = (pair.face.press(pair.scene, run) for run in pair.trajectories)
    against, expected_depth, expected = "float64", depth64, back64
    if pair.scene.name.startswith(EDGE):
        against, expected_depth = "closed form", single_edge.DEPTH
        expected = single_edge.bounce_back(pair.scene.materials[0])

    def reading(quantity, circuit, float64, expected):
        scale = abs(expected) if abs(expected) > SMALL * expected_depth else expected_depth
        return Reading(pair.scene.name, quantity, "m", circuit, float64, against, expected, scale, RECOVERY)

    return [
        reading("bounce-back", back, back64, expected),
        reading("residual", depth - back, depth64 - back64, expected_depth - expected),
    ]


def deformation(pair: Pair, run: Trajectory) -> np.ndarray:
    """Return (F,) in m, how deep the watched face is pressed, or how far it has sunk."""
    height = pair.face.height(run)
    return (pair.face.direction if pair.face.pressed else -pair.face.direction) * (height - height[0])


def bulges(scene: Scene, x: np.ndarray) -> np.ndarray:
    """Return (4,) in m, how far the middles of a block's upright sides are pushed outwards, from positions (N, 3)."""
    initial, nodes = scene.mesh.points, side_middles(scene)
    outwards = (initial - initial.mean(axis=0))[nodes]
    outwards /= np.linalg.norm(outwards, axis=1, keepdims=True)
    return np.einsum("ij,ij->i", (x - initial)[nodes], outwards)


def side_middles(scene: Scene) -> np.ndarray:
    """Return (4,), the nodes in the middle of a block's sides: lower and upper x, lower and upper y."""
    points = scene.mesh.points
    low, high = points.min(axis=0), points.max(axis=0)
    wanted = np.tile((low + high) / 2, (4, 1))
    wanted[[0, 1], 0] = low[0], high[0]
    wanted[[2, 3], 1] = low[1], high[1]
    return np.linalg.norm(points[None] - wanted[:, None], axis=2).argmin(axis=1)


def bulge(pair: Pair) -> Reading:
    """Return the mean bulge of the four sides (m) while the block is held pressed."""
    circuit, float64 = (float(bulges(pair.scene, x[pair.released]).mean()) for x in pair.x)
    return Reading(
        pair.scene.name, "side bulge", "m", circuit, float64, "float64", float64, pair.scene.size, BULGE, positive=True
    )


def bulge_over_time(pair: Pair, run: Trajectory) -> np.ndarray:
    """Return (F,) in m, the mean bulge of a block's sides."""
    return np.array([bulges(pair.scene, x).mean() for x in run.x])


def fall(pair: Pair) -> Reading:
    """Return the height (m) that a block has lost under its own weight in the end."""
    circuit, float64 = (float(deformation(pair, run)[-1]) for run in pair.trajectories)
    return Reading(
        pair.scene.name,
        "height lost",
        "m",
        circuit,
        float64,
        "float64",
        float64,
        pair.scene.size,
        BOUND[pair.scene.force_dependent],
    )


def apart(pair: Pair) -> Reading:
    """Return the largest distance of a node between circuit and float64 in any frame, over the object's size."""
    return Reading(
        pair.scene.name,
        "max dx",
        "size",
        pair.difference(),
        0.0,
        "float64",
        0.0,
        1.0,
        BOUND[pair.scene.force_dependent],
    )
