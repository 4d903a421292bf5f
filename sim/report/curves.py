"""The difference, the way of a face and its force over time."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from golden.formats import Formats
from golden.problem import Scene
from sim.compare import BOUND, Comparison, power
from sim.face import watched
from sim.report import style


def draw(comparison: Comparison) -> Figure:
    scene, float64, rtl = comparison.scene, comparison.float64.trajectory, comparison.rtl.trajectory
    face = watched(scene)
    figure = style.figure(3.4)
    way, force, difference = figure.subplots(1, 3)
    axis = "xyz"[face.axis]

    for axes, curve, label in (
        (way, lambda run: face.height(run) * 1e3, f"{axis} of the {face.name}, mean (mm)"),
        (force, face.force, f"force on the {face.name} (N)" if face.pressed else "force of the supports (N)"),
    ):
        axes.plot(float64.t, curve(float64), **style.FLOAT_LINE, label="float64")
        axes.plot(rtl.t, curve(rtl), **style.CIRCUIT_LINE, label="circuit")
        axes.set_ylabel(label)
    way.legend(frameon=False)

    dx, bound = comparison.dx_rel(), BOUND[scene.force_dependent]
    step = Formats().position.lsb
    difference.semilogy(rtl.t, np.where(dx > 0, dx, np.nan), color=style.CIRCUIT, linewidth=1.6)
    difference.axhline(bound, color=style.BOUND, linestyle="--", linewidth=1.3)
    difference.axhline(step, color=style.QUIET, linestyle=":", linewidth=1.3)
    for y, text, colour in ((bound, f"allowed: {power(bound)}", style.BOUND),
                            (step, "last bit of a position", style.QUIET)):
        difference.annotate(text, (1, y), (-2, 3), xycoords=("axes fraction", "data"), textcoords="offset points",
                            ha="right", color=colour, fontsize=9)
    difference.set_ylim(step / 4, bound * 6)
    difference.set_ylabel("largest position difference / size")

    for axes in (way, force, difference):
        style.quiet(axes)
        axes.set_xlabel("time (s)")
        axes.set_xlim(0, float64.t[-1])
        _phases(axes, scene)
    return figure


def _phases(axes, scene: Scene) -> None:
    """A line where a phase ends, and its name above."""
    ends = np.cumsum([0] + [phase.steps for phase in scene.phases]) * scene.dt
    for phase, start, end in zip(scene.phases, ends[:-1], ends[1:], strict=True):
        axes.axvline(start, color=style.QUIET, linewidth=0.8)
        axes.annotate(phase.name, ((start + end) / 2, 1), (0, 3), xycoords=("data", "axes fraction"),
                      textcoords="offset points", ha="center", color=style.QUIET, fontsize=9)
