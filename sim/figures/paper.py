"""The look of all figures: sizes in inches and points, to be read on paper and in black and white."""

from __future__ import annotations

from matplotlib.figure import Figure

WIDTH = 7.1  # inches: across both columns of a page
SCALE = 0.0143  # inches per mm of all flat objects
INK, PALE = "#222222", "#6b6b6b"
SETTINGS = {
    "font.family": "DejaVu Sans",  # comes with matplotlib
    "font.size": 8,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "axes.linewidth": 0.7,
    "lines.linewidth": 1.4,
    "axes.edgecolor": INK,
    "text.color": INK,
    "axes.labelcolor": INK,
    "svg.hashsalt": "rheogate",
    "svg.fonttype": "path",
    "path.simplify": False,
}

BLUE, GREEN, RED, SKY = "#0072b2", "#009e73", "#d55e00", "#56b4e9"  # Okabe and Ito's colours
LINES = BLUE, GREEN, RED, SKY
# by colour, by dashes, and by what stands beside the curve
MATERIALS = {
    "viscoelastic": {"color": BLUE, "linestyle": "-"},
    "rheological": {"color": GREEN, "linestyle": (0, (6, 1.5))},
    "plastic": {"color": RED, "linestyle": (0, (6, 1.5, 1, 1.5))},
}
OUTLINE = {"colors": INK, "linewidths": 0.8, "linestyles": [(0, (4, 3))]}
MESH = {"edgecolors": INK, "linewidths": 0.45, "snap": False}
NODES = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 2.6,
    "markerfacecolor": "white",
    "markeredgecolor": INK,
    "markeredgewidth": 0.55,
}
FLOAT = {"linewidth": 4.2, "alpha": 0.3, "linestyle": "-", "solid_capstyle": "round"}
"""float64 under a curve of the circuit, in its colour."""


def place(figure: Figure, left: float, bottom: float, width: float, height: float):
    """Return axes at a position and of a size in inches."""
    w, h = figure.get_size_inches()
    return figure.add_axes((left / w, bottom / h, width / w, height / h))


def object_axes(figure: Figure, left: float, bottom: float, x: tuple, y: tuple, scale: float = SCALE):
    """Return bare axes for an object between these limits (mm), ``scale`` inches per mm in both directions."""
    axes = place(figure, left, bottom, (x[1] - x[0]) * scale, (y[1] - y[0]) * scale)
    axes.set(xlim=x, ylim=y)
    axes.set_axis_off()
    return axes


def scale_bar(axes, x: float, y: float, length: float = 20) -> None:
    """Draw a line of so many mm with its length beside it."""
    axes.plot([x, x + length], [y, y], color=INK, linewidth=1.6, solid_capstyle="butt")
    axes.annotate(f"{length:g} mm", (x + length, y), (3, 0), textcoords="offset points", va="center", fontsize=7)


def title(axes, text: str) -> None:
    """Write a title above an object, from the left."""
    axes.set_title(text, x=0.02, ha="left", pad=2)


def mm(length: float) -> str:
    """Return a length in m as mm with two decimals; no negative zero."""
    return minus(f"{round(length * 1e3, 2) + 0:.2f} mm")


def minus(text: str) -> str:
    """Return the text with typographic minus signs."""
    return text.replace("-", "\N{MINUS SIGN}")


def arrow(axes, x: float, low: float, high: float, text: str) -> None:
    """Draw a dimension between two heights with its text beside it, or only the text where an arrow has no room."""
    if high - low > 2:
        axes.annotate(
            "",
            (x, high),
            (x, low),
            arrowprops={
                "arrowstyle": "<->",
                "shrinkA": 0,
                "shrinkB": 0,
                "linewidth": 0.9,
                "color": INK,
                "mutation_scale": 7,
            },
        )
    axes.annotate(text, (x, (low + high) / 2), (6, 0), textcoords="offset points", va="center", fontsize=7.5)


def note(figure: Figure, text: str) -> None:
    """Write a line below a figure."""
    w, h = figure.get_size_inches()
    figure.text(0.1 / w, 0.06 / h, text, fontsize=7, color=PALE, va="bottom")
