"""Figures 3, 4 and 5: a flat block of one material at its start, held pressed, and when it has come to rest."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from sim.figures import curves, paper, reading
from sim.figures.body import STRAIN, Body
from sim.figures.film import Film
from sim.figures.runs import Pair
from sim.results.comparison import power

X, Y = (-10, 112), (-8, 103)  # mm, around the block
ROOM = 90  # mm beside the last drawing, for the measurements


def draw(pairs: list[Pair]) -> Figure:
    """Draw the three states of a block, coloured by strain, with one colour scale and one length scale."""
    (pair,) = pairs
    figure = Figure((paper.WIDTH, 2.15))
    frames = [0, pair.released, len(pair.circuit.trajectory.t) - 1]
    left = 0.0
    for number, (frame, title) in enumerate(zip(frames, ("initial", "deformed", "stationary"), strict=True)):
        x = (X[0], X[1] + ROOM * (number == 2))
        axes = paper.object_axes(figure, left, 0.27, x, Y)
        left += (x[1] - x[0]) * paper.SCALE
        Body(axes, pair, STRAIN, frame)
        paper.title(axes, f"({'abc'[number]}) {title}, {pair.circuit.trajectory.t[frame]:.3g} s")
        if number == 0:
            paper.scale_bar(axes, 0, -6)
    measured(axes, pair)
    STRAIN.bar(figure, paper.place(figure, paper.WIDTH - 0.52, 0.36, 0.1, 1.5))
    paper.note(
        figure,
        f"{pair.scene.name.capitalize()}. Mesh and colours: circuit. Circles: float64, at most "
        f"{power(pair.difference())} of the block's size away at any time. Dashed: initial outline.",
    )
    return figure


def measured(axes, pair: Pair) -> None:
    """Draw bounce-back and residual as dimensions beside the block."""
    back, residual = (r.circuit for r in reading.press(pair))
    right, top = pair.scene.mesh.points.max(axis=0) * 1e3
    final, pressed = top - residual * 1e3, top - (residual + back) * 1e3
    for height in (top, final, pressed):
        axes.plot([right + 3, right + 12], [height, height], color=paper.INK, linewidth=0.5)
    for name, value, low, high in (("residual", residual, final, top), ("bounce-back", back, pressed, final)):
        paper.arrow(axes, right + 8, low, high, f"{name} {paper.mm(value)}")


def film(pairs: list[Pair]) -> Film:
    """Make the film: the block in motion, and beside it how deep it is pressed and with which force."""
    (pair,) = pairs
    figure = Figure((6.4, 2.75))
    axes = paper.object_axes(figure, 0.05, 0.1, X, (Y[0], 112), 0.0205)  # it swings
    body = Body(axes, pair, STRAIN)
    paper.scale_bar(axes, 0, -6)
    STRAIN.bar(figure, paper.place(figure, 2.72, 0.4, 0.09, 1.9))
    name = figure.text(0.2 / 6.4, 2.6 / 2.75, "", fontsize=9, va="center")
    way, force = (paper.place(figure, 3.78, bottom, 2.5, 0.85) for bottom in (1.6, 0.4))
    way.set_title("deformation (mm)", loc="left", pad=3)
    force.set_title("force (N)", loc="left", pad=3)
    force.set_xlabel("time since the release (s)")
    force.xaxis.labelpad = 1
    dots = [
        curves.over_time(axes, pair, quantity)
        for axes, quantity in ((way, curves.deformation(pair)), (force, pair.face.force))
    ]
    for axes in (way, force):
        curves.time_axis(axes, curves.WAY)
    offset = pair.circuit.trajectory.t[pair.released]

    def show(t: float) -> None:
        body.show(pair.frame(t))
        name.set_text(f"{pair.scene.name}: {doing(pair, t)}, {t:.2f} s")
        for dot in dots:
            dot.show(t - offset)

    return Film(figure, show, 0.0, float(pair.circuit.trajectory.t[-1]))


def doing(pair: Pair, t: float) -> str:
    """Return the name of the phase at the time t (s)."""
    frame = pair.frame(t)
    return pair.scene.phases[int(np.searchsorted(pair.scene.end_frames, max(frame, 1)))].name
