"""Figure 6: blocks of the three materials in three dimensions; pressing the top makes their sides bulge."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure

from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from sim.figures import curves, paper, reading
from sim.figures.body import STRAIN, Body
from sim.figures.film import Film
from sim.figures.runs import Pair
from sim.report.surface import outline, projected
from sim.results.comparison import power

SCALE, PLAN_SCALE = 0.0101, 0.0118  # inches per mm of all solid objects, and of the views from above
MARGIN = np.array([7, 3])  # mm around a drawing, for the bulge
PLAN = (-8, 108)  # mm, limits of the views from above, in both directions
ROW, TITLE, BELOW = 1.55, 0.08, 0.3  # inches


def draw(pairs: list[Pair]) -> Figure:
    """Draw a row for each material: three states and the middle from above, with one scale and one colour scale."""
    figure = Figure((paper.WIDTH, ROW * len(pairs) + TITLE + BELOW))
    height = figure.get_figheight()
    x, y = limits(pairs[0].scene)
    for row, pair in enumerate(pairs):
        bottom, left = BELOW + ROW * (len(pairs) - 1 - row), 0.2
        middle = (bottom + (y[1] - y[0]) * SCALE / 2) / height
        figure.text(
            0.1 / paper.WIDTH, middle, curves.material(pair), rotation=90, va="center", ha="center", fontsize=8.5
        )
        end = len(pair.circuit.trajectory.t) - 1
        for frame, title in ((0, "initial"), (pair.released, "deformed"), (end, "stationary")):
            axes = paper.object_axes(figure, left, bottom, x, y, SCALE)
            left += (x[1] - x[0]) * SCALE
            Body(axes, pair, STRAIN, frame)
            paper.title(axes, f"{title}, {pair.circuit.trajectory.t[frame]:.3g} s")
            if row == len(pairs) - 1 and frame == 0:
                paper.scale_bar(axes, x[0] + 2, y[0] + 4)
        plan(paper.object_axes(figure, left, bottom, PLAN, PLAN, PLAN_SCALE), pair)
    STRAIN.bar(figure, paper.place(figure, paper.WIDTH - 0.5, height / 2 - 1, 0.1, 2))
    apart = power(max(pair.difference() for pair in pairs))
    paper.note(
        figure,
        f"Mesh and colours: circuit. Circles: float64, at most {apart} of the block's size away at any "
        "time. Dashed: initial outline.",
    )
    return figure


def limits(scene: Scene) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return limits in x and y (mm, in the picture) around a block and its bulge."""
    corners = projected(outline(scene.mesh)).reshape(-1, 2) * 1e3
    (left, low), (right, high) = corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN
    return (left, right), (low, high)


def plan(axes, pair: Pair) -> None:
    """Draw the nodes around the block's middle as it is held pressed, from above, with the bulge of its sides."""
    nodes = ring(pair.scene)
    circuit, float64 = (x[pair.released, nodes, :2] * 1e3 for x in pair.x)
    axes.fill(
        *(pair.scene.mesh.points[nodes, :2] * 1e3).T,
        facecolor="none",
        edgecolor=paper.INK,
        linewidth=0.8,
        linestyle=(0, (4, 3)),
    )
    axes.fill(*circuit.T, facecolor="#dcebf4", edgecolor=paper.INK, linewidth=1.2, zorder=0)
    axes.plot(*float64.T, **paper.NODES)
    read = reading.bulge(pair)
    axes.text(
        50,
        50,
        f"sides bulge by\n{paper.mm(read.circuit)} ({100 * read.circuit / read.scale:.1f} %)\n"
        f"float64: {paper.mm(read.float64)}",
        va="center",
        ha="center",
        fontsize=7.5,
        linespacing=1.4,
    )
    paper.title(axes, f"half height, {pair.circuit.trajectory.t[pair.released]:.3g} s")


def ring(scene: Scene) -> np.ndarray:
    """Return the nodes on the sides of a block at half of its height, in order around it."""
    points = scene.mesh.points
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    away = points - centre
    level = np.abs(away[:, 2]) < 1e-6 * scene.size
    rim = level & (np.abs(away[:, :2]).max(axis=1) > (0.5 - 1e-6) * scene.size)
    nodes = np.flatnonzero(rim)
    return nodes[np.argsort(np.arctan2(away[nodes, 1], away[nodes, 0]))]


def film(pairs: list[Pair]) -> Film:
    """Make the film: the blocks side by side, and how far their sides bulge over time."""
    figure = Figure((7.2, 4.0))
    x, y = limits(pairs[0].scene)
    bodies, dots = [], []
    over = paper.place(figure, 0.5, 0.42, 5.6, 1.3)
    over.set_title("bulge of the sides (mm)", loc="left", pad=3)
    for number, pair in enumerate(pairs):
        axes = paper.object_axes(figure, 0.05 + 2.08 * number, 2.05, x, y, 0.0125)
        bodies.append((pair, Body(axes, pair, STRAIN)))
        axes.set_title(curves.material(pair), color=paper.MATERIALS[curves.material(pair)]["color"], pad=0)
        dots.append(curves.over_time(over, pair, bulge(pair)))
    curves.time_axis(over, (-0.21, 0.31))
    over.set_xlabel("time since the release (s)", labelpad=1)
    STRAIN.bar(figure, paper.place(figure, 6.55, 0.9, 0.1, 2.3))
    clock = figure.text(5.1 / 7.2, 0.08 / 4.0, "", fontsize=9)
    return Film(figure, curves.moving(bodies, dots, clock), -0.2, 0.3)


def bulge(pair: Pair) -> Callable[[Trajectory], np.ndarray]:
    """Return a function from a run to (F,) in mm, the mean bulge of the sides."""
    return lambda run: reading.bulge_over_time(pair, run) * 1e3
