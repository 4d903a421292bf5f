"""The watched face: the nodes of an object whose travel and force are shown over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Face:
    """Nodes of an object, and the axis and direction in which their motion is watched."""

    name: str
    nodes: np.ndarray  # (N,) bool
    axis: int
    pressed: bool  # by a driving device; else it is the top of an object under loads alone
    direction: float  # of the press along the axis, or upwards: +1 or -1

    def height(self, trajectory: Trajectory) -> np.ndarray:
        """Return (F,) the nodes' mean coordinate along the axis (m)."""
        return trajectory.x[:, self.nodes, self.axis].mean(axis=1)

    def force(self, trajectory: Trajectory) -> np.ndarray:
        """Return (F,) the force (N) that the device presses with; without a device, the load on the supports."""
        nodes = self.nodes if self.pressed else slice(None)
        return self.direction * trajectory.reaction[:, nodes, self.axis].sum(axis=1)

    def press(self, scene: Scene, trajectory: Trajectory) -> tuple[float, float] | None:
        """Return the depth of the press and the way back until the end (m, both along the press); None if nothing
        pressed or nothing was let go."""
        driving = [n for n, phase in enumerate(scene.phases) if (phase.driven & self.nodes).any()]
        if not self.pressed or (scene.phases[-1].held & self.nodes).any():
            return None
        initial, pressed, final = self.height(trajectory)[[0, scene.end_frames[driving[-1]], -1]]
        return float(self.direction * (pressed - initial)), float(self.direction * (pressed - final))

    def recovery(self, scene: Scene, trajectory: Trajectory) -> float | None:
        """Return the part of the press that is undone in the end, 0 to 1; None if nothing pressed or was let go."""
        depth, back = self.press(scene, trajectory) or (0.0, 0.0)
        return back / depth if depth else None


def watched(scene: Scene) -> Face:
    """Return the face that the first drive moves; of an object that isn't driven, its top."""
    for phase in scene.phases:
        speed = np.linalg.norm(phase.velocity, axis=1) * phase.driven
        if speed.any():
            fastest = phase.velocity[np.argmax(speed)]
            nodes = phase.driven & (phase.velocity @ fastest > 0)
            axis = int(np.argmax(np.abs(fastest)))
            return Face("driven face", nodes, axis, True, float(np.sign(fastest[axis])))
    weight = scene.gravity if scene.gravity.any() else -np.eye(scene.dim)[-1]
    axis = int(np.argmax(np.abs(weight)))
    up = -float(np.sign(weight[axis]))
    along = up * scene.mesh.points[:, axis]
    return Face("top", along > along.max() - 1e-6 * scene.size, axis, False, up)
