"""An object in a picture: faces coloured by strain or by ratio as the circuit has them, float64's nodes on top."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import ListedColormap, Normalize

from golden.mesh.mesh import Mesh
from golden.physics.trajectory import Trajectory
from sim.figures import paper
from sim.figures.runs import Pair
from sim.report.surface import once, outline, projected, surface, visible

# from nearly white to dark blue, without the darkest, on which a mesh cannot be seen; it gets steadily darker, so it
# also works in grey and for colour-blind readers
COLOURS = ListedColormap(colormaps["YlGnBu"](np.linspace(0.02, 0.85, 256)), "strain")


@dataclass(frozen=True)
class Shade:
    """A quantity of edges as a colour of the faces between them."""

    label: str
    norm: Normalize
    of_edges: Callable[[Trajectory, int], np.ndarray]  # (E,) in a frame
    of_sides: Callable[[np.ndarray], np.ndarray]  # (S,) of faces from (S, 3) of their sides
    ticks: tuple[float, ...]
    extend: str = "neither"  # "both": the bar's ends show that values lie beyond them

    def bar(self, figure, axes) -> None:
        """Draw the colour bar in axes of its own."""
        bar = figure.colorbar(ScalarMappable(self.norm, COLOURS), cax=axes, ticks=self.ticks, extend=self.extend)
        bar.set_label(self.label)
        bar.outline.set_linewidth(0.6)


def strain(run: Trajectory, frame: int) -> np.ndarray:
    """Return (E,) in %, how much longer each edge is than in the first frame."""
    start, now = (np.linalg.norm(x[run.edges[:, 1]] - x[run.edges[:, 0]], axis=1) for x in run.x[[0, frame]])
    return 100 * (now / start - 1)


STRAIN = Shade(
    "strain of the edges, r.m.s. (%)",
    Normalize(0, 25),
    strain,
    lambda sides: np.sqrt((sides**2).mean(axis=1)),
    (0, 5, 10, 15, 20, 25),
)
RATIO = Shade(
    "ratio a of the edges, mean",
    Normalize(0.5, 0.65),
    lambda run, frame: run.a[frame],
    lambda sides: sides.mean(axis=1),
    (0.5, 0.55, 0.6, 0.65),
    "both",
)


class Body:
    """A drawing of an object that can move to another frame. Lengths in mm."""

    def __init__(self, axes, pair: Pair, shade: Shade, frame: int = 0):
        mesh = pair.scene.mesh
        self._pair, self._shade, self._faces = pair, shade, surface(mesh)
        self._painted = PolyCollection([], cmap=COLOURS, norm=shade.norm, joinstyle="round", **paper.MESH)
        axes.add_collection(self._painted)
        self._outline = LineCollection(projected(outline(mesh)) * 1e3, zorder=3, **paper.OUTLINE)
        axes.add_collection(self._outline)
        nodes = paper.NODES if mesh.dim == 2 else paper.NODES | {"markersize": 2.0}
        (self._nodes,) = axes.plot([], [], zorder=4, **nodes)
        self.show(frame)

    def show(self, frame: int) -> None:
        """Draw the object as it is in a frame."""
        mesh, run = self._pair.scene.mesh, self._pair.circuit.trajectory
        seen, _ = visible(run.x[frame], self._faces)
        values = self._shade.of_edges(run, frame)[sides(mesh, seen)]
        self._painted.set_verts(projected(run.x[frame])[seen] * 1e3)
        self._painted.set_array(self._shade.of_sides(values))
        nodes = border(mesh) if mesh.dim == 2 else np.unique(seen)
        self._nodes.set_data(*(projected(self._pair.float64.trajectory.x[frame, nodes]) * 1e3).T)
        self._outline.set_visible(frame > 0)


def sides(mesh: Mesh, faces: np.ndarray) -> np.ndarray:
    """Return (S, 3), the edges between the corners of each face."""
    n = len(mesh.points)
    i, j = np.sort(faces[:, [(0, 1), (1, 2), (2, 0)]], axis=2).transpose(2, 0, 1)
    return np.searchsorted(mesh.edges @ (n, 1), i * n + j)


def border(mesh: Mesh) -> np.ndarray:
    """Return the nodes on the border of a flat mesh."""
    edges = sides(mesh, mesh.cells).ravel()
    return np.unique(mesh.edges[edges[once(edges[:, None])]])
