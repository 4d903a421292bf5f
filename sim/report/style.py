"""Colours and lines that all pictures share. The colours are Okabe and Ito's, for colour-blind readers too."""

from matplotlib import colormaps
from matplotlib.colors import LinearSegmentedColormap

CIRCUIT, BOUND = "#0072b2", "#d55e00"


def scales() -> dict[str, object]:
    """Return the colour map of each quantity: ratios and differences get lighter as they grow, for colour-blind readers
    too; forces go from pulling (blue) over none to pushing (vermilion)."""
    force = LinearSegmentedColormap.from_list("force", [CIRCUIT, "#7fbde0", "#dcdcdc", "#f0a868", BOUND])
    return {"ratio": colormaps["viridis"], "force": force, "apart": colormaps["cividis"]}


def quiet(axes) -> None:
    """Style a plot: a light grid below the curves."""
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(color="#e6e6e6", linewidth=0.7)
    axes.set_axisbelow(True)
