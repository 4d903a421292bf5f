"""Colours and lines that all pictures share. The colours are Okabe and Ito's, for colour-blind readers too."""

from matplotlib import colormaps
from matplotlib.colors import LinearSegmentedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

FLOAT, CIRCUIT, BOUND, QUIET = "#e69f00", "#0072b2", "#d55e00", "#666666"
FLOAT_MESH, FLOAT_FILL = "#ffc94d", to_rgb("#fff3d6")
WIDE, THIN = 4.0, 1.4  # points: float64, and the circuit on top of it
FLOAT_LINE = {"color": FLOAT_MESH, "linewidth": 5.5, "solid_capstyle": "round"}
CIRCUIT_LINE = {"color": CIRCUIT, "linewidth": 1.5}
OUTLINE = {"color": "#222222", "linewidth": 1.0, "linestyle": (0, (5, 4))}
WIDTH = 12.0  # inches, of every picture


def scales() -> dict[str, object]:
    """Return the colour map of each quantity: ratios and differences get lighter as they grow, for colour-blind readers
    too; forces go from pulling (blue) over none to pushing (vermilion)."""
    force = LinearSegmentedColormap.from_list("force", [CIRCUIT, "#7fbde0", "#dcdcdc", "#f0a868", BOUND])
    return {"ratio": colormaps["viridis"], "force": force, "apart": colormaps["cividis"]}


def figure(height: float) -> Figure:
    return Figure((WIDTH, height), layout="constrained")


def panels(columns: int, tall: float):
    """Return a figure with axes side by side, each ``tall`` times as high as wide (at most 1.5 times), with room for a
    title, numbers below and a legend."""
    left, right, above, below, gap = 0.45, 0.1, 0.4, 0.95, 0.3  # inches
    width = (WIDTH - left - right - gap * (columns - 1)) / columns
    height = width * min(tall, 1.5)
    full = above + height + below
    figure = Figure((WIDTH, full))
    axes = figure.subplots(
        1,
        columns,
        sharex=True,
        sharey=True,
        gridspec_kw={
            "left": left / WIDTH,
            "right": 1 - right / WIDTH,
            "bottom": below / full,
            "top": 1 - above / full,
            "wspace": gap / width,
        },
    )
    return figure, axes


def legend() -> list[Line2D]:
    return [
        Line2D([], [], **FLOAT_LINE, label="float64"),
        Line2D([], [], **CIRCUIT_LINE, label="circuit"),
        Line2D([], [], **OUTLINE, label="initial outline"),
    ]


def quiet(axes) -> None:
    """Style a plot: a light grid below the curves."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#e6e6e6", linewidth=0.7)
    axes.set_axisbelow(True)


def bare(axes, scale: bool, left: bool) -> None:
    """Style a drawing: no frame, and numbers beside it only where lengths can be read."""
    axes.spines[:].set_visible(False)
    if scale:
        axes.set_xlabel("mm")
    axes.tick_params(left=scale and left, bottom=scale, labelbottom=scale, labelleft=scale and left)
