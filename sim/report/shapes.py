"""The object at its start, deformed and in the end, float64 and circuit over each other."""

from __future__ import annotations

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from golden.problem import Scene
from golden.trajectory import Trajectory
from sim.compare import Comparison
from sim.report import style
from sim.report.surface import outline, projected, surface, visible

AT_REST = 0.01  # sizes per second: below this speed the end is called stationary


def draw(comparison: Comparison) -> Figure:
    mesh = comparison.scene.mesh
    float64, rtl = comparison.float64.trajectory, comparison.rtl.trajectory
    shots = chosen(comparison.scene, float64)
    faces = surface(mesh)
    dashed = projected(outline(mesh)) * 1e3
    shown = [projected(float64.x[frame]) * 1e3 for frame, _ in shots]
    low, high = (limit(np.concatenate([*shown, dashed.reshape(-1, 2)]), axis=0) for limit in (np.min, np.max))
    margin = 0.03 * (high - low).max()

    wide, tall = high - low + 2 * margin
    figure, columns = style.panels(len(shots), tall / wide)
    for axes, (frame, title) in zip(columns, shots, strict=True):
        axes.add_collection(layers(float64.x[frame] * 1e3, rtl.x[frame] * 1e3, faces))
        if frame:
            axes.add_collection(LineCollection(dashed, **style.OUTLINE))
        axes.set(aspect="equal", xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
        axes.set_title(title, fontsize=11)
        style.bare(axes, scale=mesh.dim == 2, left=axes is columns[0])
    figure.legend(handles=style.legend(), loc="lower center", ncols=3, frameon=False)
    return figure


def chosen(scene: Scene, run: Trajectory) -> list[tuple[int, str]]:
    """(frame, title): the first, the one at the end of the first phase (of a single one, in its middle), the last."""
    first, last = scene.phases[0], len(run.t) - 1
    end = int(np.searchsorted(scene.frames, first.steps))
    middle, when = (end, "end of") if len(scene.phases) > 1 else (end // 2, "during")
    rest = np.linalg.norm(run.v[last], axis=1).max() < AT_REST * scene.size
    return [(0, "initial"),
            (middle, f"deformed: {when} {first.name}, {run.t[middle]:.3g} s"),
            (last, f"{'stationary' if rest else 'final'}: end of {scene.phases[-1].name}, {run.t[last]:.3g} s")]


def layers(float64: np.ndarray, circuit: np.ndarray, faces: np.ndarray) -> PolyCollection:
    """The faces, filled and edged for float64, then edged for the circuit: face by face from behind to the front,
    so that each hides what is behind it, or, where nothing is behind, the circuit's on top of all."""
    seen, light = visible(float64, faces)
    shade = np.array(style.FLOAT_FILL) * (0.8 + 0.2 * light[:, None])
    corners = np.concatenate([projected(float64)[seen], projected(circuit)[seen]])
    fill = np.concatenate([np.insert(shade, 3, 1, axis=1), np.zeros((len(seen), 4))])
    order = np.arange(2 * len(seen))
    if float64.shape[1] == 3:
        order = order.reshape(2, -1).T.ravel()
    upon = order >= len(seen)
    return PolyCollection(
        corners[order], facecolors=fill[order], edgecolors=np.where(upon, style.CIRCUIT, style.FLOAT_MESH),
        linewidths=np.where(upon, style.THIN, style.WIDE), joinstyle="round")
