"""Figure 1: objects of the three materials over time, as they are pressed, held and let go."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

from golden.physics.trajectory import Trajectory
from sim.figures import paper, reading
from sim.figures.body import STRAIN, Body
from sim.figures.film import Film
from sim.figures.parts import Parts
from sim.figures.runs import EDGE, Pair
from sim.report import style

WAY, PRESS = (-0.27, 0.6), (-0.27, 0.06)  # s around the release, on the axes of deformation and of force
CLOSED = {
    "linestyle": "none",
    "marker": "D",
    "markersize": 4.2,
    "markerfacecolor": "white",
    "markeredgecolor": paper.INK,
    "markeredgewidth": 0.9,
}


def draw(pairs: list[Pair]) -> Figure:
    """Draw deformation and force over time: single edges above, blocks below."""
    figure = Figure((paper.WIDTH, 4.75))
    for row, (kind, name, bottom) in enumerate(zip(objects(pairs), ("single edge", "block"), (2.86, 0.7), strict=True)):
        way, force = (paper.place(figure, left, bottom, width, 1.6) for left, width in ((0.42, 2.9), (4.92, 2.1)))
        way.set_title(f"({'ac'[row]}) {name}: deformation (mm)", loc="left")
        force.set_title(f"({'bd'[row]}) {name}: force (N)", loc="left")
        for pair in kind:
            over_time(way, pair, deformation(pair))
            over_time(force, pair, pair.face.force)
        for axes, limits in ((way, WAY), (force, PRESS)):
            time_axis(axes, limits)
            if row:
                axes.set_xlabel("time since the release (s)")
        labels(way, kind)
    handles = [Line2D([], [], label=name, **line) for name, line in paper.MATERIALS.items()]
    handles += [
        Line2D([], [], color=paper.PALE, label="float64, beneath", **paper.FLOAT),
        Line2D([], [], label="closed form", **CLOSED),
    ]
    figure.legend(
        handles=handles,
        loc="lower center",
        ncols=5,
        frameon=False,
        fontsize=7.5,
        handlelength=3.4,
        columnspacing=1.5,
        borderaxespad=0.2,
    )
    return figure


def deformation(pair: Pair) -> Callable[[Trajectory], np.ndarray]:
    """Return a function from a run to (F,) in mm, how deep the face is pressed."""
    return lambda run: reading.deformation(pair, run) * 1e3


def objects(pairs: list[Pair]) -> tuple[list[Pair], list[Pair]]:
    """Return the single edges, and the blocks."""
    edges = [pair for pair in pairs if pair.scene.name.startswith(EDGE)]
    return edges, [pair for pair in pairs if pair not in edges]


class Dot:
    """A point that moves along a curve of (F,) values over (F,) times."""

    def __init__(self, axes, t: np.ndarray, values: np.ndarray, colour: str):
        self._t, self._values = t, values
        (self._dot,) = axes.plot([], [], "o", markersize=5.5, color=colour, markeredgecolor="white", zorder=5)

    def show(self, t: float) -> None:
        """Move to a time; outside the curve the point is hidden."""
        within = self._t[0] <= t <= self._t[-1] + 1e-9
        self._dot.set_data(([t], [np.interp(t, self._t, self._values)]) if within else ([], []))


def over_time(axes, pair: Pair, quantity: Callable[[Trajectory], np.ndarray]) -> Dot:
    """Draw a quantity of the circuit over time with float64's, wide and pale, below it; return a dot for films."""
    line = paper.MATERIALS[material(pair)]
    circuit, float64 = pair.trajectories
    t, values = since_release(pair), quantity(circuit)
    known = np.isfinite(values)  # the circuit knows no force before its first step
    axes.plot(t[known], quantity(float64)[known], color=line["color"], zorder=1, **paper.FLOAT)
    axes.plot(t, values, **line)
    return Dot(axes, t[known], values[known], line["color"])


def time_axis(axes, limits: tuple[float, float]) -> None:
    """Draw an axis of seconds around the release, which is marked."""
    style.quiet(axes)
    axes.set_xlim(*limits)
    axes.xaxis.set_major_locator(MultipleLocator(0.1))
    axes.axvline(0, color=paper.INK, linewidth=0.8, linestyle=":", zorder=0.5)


def material(pair: Pair) -> str:
    """Return the material in a scene's name, without the parts that name the object."""
    return pair.scene.name.removeprefix(EDGE).removesuffix("-3d")


def since_release(pair: Pair) -> np.ndarray:
    """Return (F,) in s since the release, negative before it."""
    t = pair.circuit.trajectory.t
    return t - t[pair.released]


def labels(axes, pairs: list[Pair]) -> None:
    """Write residual and bounce-back beside the end of each curve."""
    for pair in pairs:
        back, residual = reading.press(pair)
        axes.annotate(
            f"{material(pair)}\nresidual {paper.mm(residual.circuit)}\nbounce-back {paper.mm(back.circuit)}",
            (WAY[1], residual.circuit * 1e3),
            (7, 0),
            textcoords="offset points",
            va="center",
            fontsize=7.2,
            color=paper.MATERIALS[material(pair)]["color"],
            annotation_clip=False,
        )
        if residual.against == "closed form":
            axes.plot(since_release(pair)[-1], residual.expected * 1e3, zorder=4, clip_on=False, **CLOSED)


def film(pairs: list[Pair]) -> Film:
    """Make the film: edges with their two parts and blocks as they move, and beside them how deep they are pressed."""
    figure = Figure((7.2, 4.3))
    bodies, dots = [], []
    for kind, bottom in zip(objects(pairs), (2.5, 0.55), strict=True):
        way = paper.place(figure, 4.5, bottom, 2.55, 1.45)
        way.set_title("deformation (mm)", loc="left", pad=3)
        time_axis(way, WAY)
        dots += [over_time(way, pair, deformation(pair)) for pair in kind]
        for number, pair in enumerate(kind):
            axes = paper.object_axes(figure, 0.1 + 1.36 * number, bottom - 0.05, (-10, 110), (-5, 110), 0.0113)
            edge = pair.scene.name.startswith(EDGE)
            bodies.append((pair, (Parts if edge else Body)(axes, pair, *() if edge else (STRAIN,))))
            axes.set_title(material(pair), fontsize=8.5, color=paper.MATERIALS[material(pair)]["color"], pad=2)
    way.set_xlabel("time since the release (s)", labelpad=1)
    for height, text in (
        (4.1, "single edge: spring and damper (wide), then the second damper (thin)"),
        (2.17, f"block: {len(pair.scene.mesh.edges)} such edges, coloured by strain"),
    ):
        figure.text(0.1 / 7.2, height / 4.3, text, fontsize=8)
    clock = figure.text(4.5 / 7.2, 0.08 / 4.3, "", fontsize=9)
    return Film(figure, moving(bodies, dots, clock), *WAY)


def moving(bodies, dots, clock) -> Callable[[float], None]:
    """Return a function that sets drawings (each with its pair of runs), dots on curves and a clock to a time since the
    release (s)."""

    def show(t: float) -> None:
        for pair, body in bodies:
            body.show(pair.frame(t + pair.circuit.trajectory.t[pair.released]))
        for dot in dots:
            dot.show(t)
        clock.set_text(paper.minus(f"{t:+.2f} s"))

    return show
