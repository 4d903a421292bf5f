"""Export of a run as a time series for ParaView: a VTU file for each frame and a collection of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from golden.mesh import files as meshfile
from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from golden.support.files import atomic_file
from sim.results.energy import edge_forces

COLLECTION = "run.pvd"


def vtu(scene: Scene, trajectory: Trajectory, folder: Path, track: Callable[[Iterable], Iterable] = iter) -> list[Path]:
    """Write ``frame-0000.vtu`` and so on, then ``run.pvd``, which names them with their times (s); return their
    paths.

    Points are the nodes in m, with the scene's displacement (m), velocity (m/s) and reaction (N). Cells are the edges
    and then the elements, with ratio a and force (N, above 0 where it pushes the ends apart), which float64 computes
    from the frame's state; an element has the mean of its edges. ``track`` may watch the numbers of the frames.
    """
    collection = folder / COLLECTION
    collection.unlink(missing_ok=True)
    mesh, forces = scene.mesh, edge_forces(scene, trajectory)
    of_cells = mesh.cell_edges()
    digits = max(4, len(str(len(trajectory.t) - 1)))
    paths = []
    for n in track(range(len(trajectory.t))):
        x, a, force = trajectory.x[n], trajectory.a[n], forces[n]
        paths.append(folder / f"frame-{n:0{digits}}.vtu")
        meshfile.write(
            paths[-1],
            x,
            [mesh.edges, mesh.cells],
            {
                "displacement": in_space(x - trajectory.x[0]),
                "velocity": in_space(trajectory.v[n]),
                "reaction": in_space(trajectory.reaction[n]),
            },
            {"ratio": [a, a[of_cells].mean(axis=1)], "force": [force, force[of_cells].mean(axis=1)]},
        )
    _write_collection(collection, trajectory.t, paths)
    return [*paths, collection]


def in_space(vectors: np.ndarray) -> np.ndarray:
    """Return (N, 3) of vectors (N, 2 or 3): ParaView takes two components for no vector."""
    return np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))


def _write_collection(path: Path, times: np.ndarray, paths: list[Path]) -> None:
    root = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    frames = ElementTree.SubElement(root, "Collection")
    for time, frame in zip(times.tolist(), paths, strict=True):
        ElementTree.SubElement(frames, "DataSet", timestep=repr(time), file=frame.name)
    ElementTree.indent(root)
    with atomic_file(path) as file:
        ElementTree.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)
