"""Section 6: a block under its own weight collapses with a linear damper and holds with a force-dependent one."""

from __future__ import annotations

from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from sim.figures import paper, reading
from sim.figures.body import RATIO, Body
from sim.figures.curves import Dot
from sim.figures.film import Film
from sim.figures.runs import Pair
from sim.report import style
from sim.results.comparison import power

X, Y = (-9, 111), (-3, 104)  # mm, around the block
SCALE = 0.0125  # inches per mm
TIMES = 0, 0.2, 0.8  # s
DAMPERS = {"gravity-collapses": "linear", "gravity-holds": "force-dependent"}
LINES = {
    "gravity-collapses": {"color": paper.RED, "linestyle": "-"},
    "gravity-holds": {"color": paper.BLUE, "linestyle": (0, (6, 1.5))},
}


def draw(pairs: list[Pair]) -> Figure:
    """Draw a row for each damper, coloured by ratio, and beside them the height of both blocks over time."""
    row = (Y[1] - Y[0]) * SCALE + 0.27
    figure = Figure((paper.WIDTH, row * len(pairs) + 0.32))
    for number, pair in enumerate(pairs):
        bottom, left = 0.3 + row * (len(pairs) - 1 - number), 0.33
        figure.text(
            0.2 / paper.WIDTH,
            (bottom + 50 * SCALE) / figure.get_figheight(),
            f"{DAMPERS[pair.scene.name]}\ndamper",
            rotation=90,
            va="center",
            ha="center",
            fontsize=8.5,
        )
        for time in TIMES:
            frame = pair.frame(time)
            axes = paper.object_axes(figure, left, bottom, X, Y, SCALE)
            left += (X[1] - X[0]) * SCALE
            Body(axes, pair, RATIO, frame)
            paper.title(axes, f"{pair.circuit.trajectory.t[frame]:.3g} s")
    left, width = left + 0.15, paper.WIDTH - left - 0.15
    RATIO.bar(figure, paper.place(figure, left, bottom + row + 0.05, 0.1, 1.2))
    heights(paper.place(figure, left + 0.28, bottom + 0.22, width - 0.4, 1.05), pairs)
    paper.note(
        figure,
        f"Mesh and colours: circuit. Circles: float64, at most "
        f"{power(max(pair.difference() for pair in pairs))} of the block's size away at any time. "
        "Dashed: initial outline.",
    )
    return figure


def heights(axes, pairs: list[Pair]) -> list[Dot]:
    """Draw the mean height of the top over time, and return a dot on each curve for films."""
    dots = []
    for pair in pairs:
        line = LINES[pair.scene.name]
        circuit, float64 = pair.trajectories
        axes.plot(float64.t, pair.face.height(float64) * 1e3, color=line["color"], zorder=1, **paper.FLOAT)
        axes.plot(circuit.t, pair.face.height(circuit) * 1e3, **line)
        dots.append(Dot(axes, circuit.t, pair.face.height(circuit) * 1e3, line["color"]))
        lost = reading.fall(pair)
        high = pair.face.height(circuit)[-1] * 1e3
        axes.annotate(
            f"{DAMPERS[pair.scene.name]}: {paper.mm(lost.circuit)} lost",
            (circuit.t[-1], high),
            (0, 6 if high > 85 else -14),
            textcoords="offset points",
            ha="right",
            fontsize=7.2,
            color=line["color"],
        )
    style.quiet(axes)
    axes.set(xlim=(0, circuit.t[-1]), ylim=(60, 108), xlabel="time (s)")
    axes.xaxis.set_major_locator(MultipleLocator(0.2))
    axes.set_title("height of the top (mm)", loc="left", x=-0.16, pad=4)
    return dots


def film(pairs: list[Pair]) -> Film:
    """Make the film: both blocks in motion, and their heights over time."""
    figure = Figure((7.2, 2.4))
    bodies = []
    for number, pair in enumerate(pairs):
        axes = paper.object_axes(figure, 0.05 + 2.12 * number, 0.25, X, Y, 0.0176)
        bodies.append((pair, Body(axes, pair, RATIO)))
        axes.set_title(f"{DAMPERS[pair.scene.name]} damper", color=LINES[pair.scene.name]["color"], pad=3)
    RATIO.bar(figure, paper.place(figure, 4.38, 0.5, 0.09, 1.45))
    dots = heights(paper.place(figure, 5.4, 0.5, 1.65, 1.45), pairs)
    clock = figure.text(0.2 / 7.2, 0.05 / 2.4, "", fontsize=9)

    def show(t: float) -> None:
        for pair, body in bodies:
            body.show(pair.frame(t))
        for dot in dots:
            dot.show(t)
        clock.set_text(f"{t:.2f} s")

    return Film(figure, show, 0.0, float(pairs[0].circuit.trajectory.t[-1]))
