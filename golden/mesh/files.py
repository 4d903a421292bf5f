"""Read and write mesh files. This is the only module that uses meshio."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path

import numpy as np

from golden.support.errors import InputError
from golden.support.files import atomic_path

FORMATS = {".vtu": "vtu", ".vtk": "vtk", ".msh": "gmsh"}
"""Formats that are written, by suffix: they hold triangles and tetrahedra with all digits."""
CELLS = {2: "line", 3: "triangle", 4: "tetra"}
"""Names of cells in meshio, by their number of corners."""
FIRST_ORDER = "mesh the whole object with first-order triangles or with first-order tetrahedra"


def read(path) -> tuple[np.ndarray, np.ndarray]:
    """Return points (N, 2) and triangles (M, 3), or points (N, 3) and tetrahedra (M, 4), in the file's units.

    Raises `InputError` as `golden.mesh.mesh.read` does.
    """
    points, cells = _read(Path(path))
    kind, boundary = "tetra", {"triangle", "line", "vertex"}
    if kind not in cells:
        kind, boundary = "triangle", {"line", "vertex"}
    if kind not in cells:
        raise InputError(f"file must hold triangles or tetrahedra, not {_listing(cells)} (in {path}): {FIRST_ORDER}")
    if other := cells.keys() - boundary - {kind}:
        raise InputError(
            f"file must hold {kind} cells alone, not {_listing(other)} beside them (in {path}): {FIRST_ORDER}"
        )
    if kind == "triangle" and points.shape[1] == 3:
        if np.ptp(points[:, 2]) > 0:
            raise InputError(
                "file must hold triangles in one plane of constant z, not a surface in space "
                f"(in {path}): make the mesh flat, or fill the surface with tetrahedra"
            )
        points = points[:, :2]
    return points, np.concatenate(cells[kind])


def write(path, points: np.ndarray, cells: list[np.ndarray], point_data=None, cell_data=None) -> None:
    """Write points (N, 2 or 3) and arrays of cells, each (M, corners), as a whole file of a suffix in `FORMATS`.

    ``point_data`` holds (N, ...) arrays by name, ``cell_data`` a list of (M, ...) ones, one for each array of cells.
    Points in a plane get z = 0.
    """
    import meshio  # as in `_read`

    path = Path(path)
    inside = np.pad(points, ((0, 0), (0, 3 - points.shape[1])))
    blocks = [(CELLS[block.shape[1]], block) for block in cells]
    mesh = meshio.Mesh(inside, blocks, point_data=point_data, cell_data=cell_data)
    with atomic_path(path) as partial:
        meshio.write(partial, mesh, file_format=FORMATS[path.suffix])


def _read(path: Path) -> tuple[np.ndarray, dict[str, list[np.ndarray]]]:
    """Return the points, and the blocks of each type of cell in the file."""
    import meshio  # imported here because it loads slowly and few scenes have a mesh file

    if not path.is_file():
        raise InputError(f"file must be an existing mesh file, not {path}")
    complaints = io.StringIO()
    try:
        with contextlib.redirect_stdout(complaints), contextlib.redirect_stderr(complaints), np.errstate(all="ignore"):
            found = meshio.read(path)
    except (Exception, SystemExit) as error:  # meshio exits, or raises whatever a broken file trips over
        raise InputError(f"file must be a mesh that meshio can read, not {path}") from error
    cells: dict[str, list[np.ndarray]] = {}
    for block in found.cells:
        if len(block.data):
            cells.setdefault(block.type, []).append(block.data)
    return found.points, cells


def _listing(kinds) -> str:
    return ", ".join(sorted(kinds)) or "nothing"
