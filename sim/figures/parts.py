"""A single edge in a picture, as its two parts: the Voigt part takes the ratio a of the length, the damper the rest."""

from __future__ import annotations

from sim.figures import paper
from sim.figures.runs import Pair

VOIGT = {"color": paper.SKY, "linewidth": 11, "solid_capstyle": "butt"}
DAMPER = {"color": paper.PALE, "linewidth": 4, "solid_capstyle": "butt"}
MIDDLE = 50  # mm, where the edge stands in its axes


class Parts:
    """A drawing of the circuit's edge with float64's ends on top, which can move to another frame. Lengths in mm."""

    def __init__(self, axes, pair: Pair):
        self._pair = pair
        top = pair.scene.mesh.points[1, 1] * 1e3
        for height in (0, top):
            axes.plot(
                [MIDDLE - 25, MIDDLE + 25],
                [height] * 2,
                color=paper.INK,
                linewidth=0.8,
                linestyle="-" if height == 0 else (0, (4, 3)),
            )
        (self._voigt,) = axes.plot([], [], **VOIGT)
        (self._damper,) = axes.plot([], [], **DAMPER)
        (self._joint,) = axes.plot([], [], color=paper.INK, linewidth=1.4)
        (self._ends,) = axes.plot([], [], **paper.NODES | {"markersize": 6})
        self.show(0)

    def show(self, frame: int) -> None:
        """Draw the edge as it is in a frame."""
        circuit, float64 = self._pair.trajectories
        low, high = circuit.x[frame, :, 1] * 1e3
        joint = low + circuit.a[frame, 0] * (high - low)
        self._voigt.set_data([MIDDLE] * 2, [low, joint])
        self._damper.set_data([MIDDLE] * 2, [joint, high])
        self._joint.set_data([MIDDLE - 8, MIDDLE + 8], [joint] * 2)
        self._ends.set_data([MIDDLE] * 2, float64.x[frame, :, 1] * 1e3)
