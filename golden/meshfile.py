"""Points and cells from mesh files. The only place that knows meshio."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path

import numpy as np

from golden.errors import InputError

FIRST_ORDER = "mesh the whole object with first-order triangles or with first-order tetrahedra"


def read(path) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 2) and triangles (M, 3), or points (N, 3) and tetrahedra (M, 4), in the file's units.

    Raises `InputError` as `golden.mesh.read` says.
    """
    points, cells = _read(Path(path))
    kind, boundary = "tetra", {"triangle", "line", "vertex"}
    if kind not in cells:
        kind, boundary = "triangle", {"line", "vertex"}
    if kind not in cells:
        raise InputError(f"file must hold triangles or tetrahedra, not {_listing(cells)} (in {path}): "
                         f"{FIRST_ORDER}")
    if other := cells.keys() - boundary - {kind}:
        raise InputError(f"file must hold {kind} cells alone, not {_listing(other)} beside them (in {path}): "
                         f"{FIRST_ORDER}")
    if kind == "triangle" and points.shape[1] == 3:
        if np.ptp(points[:, 2]) > 0:
            raise InputError("file must hold triangles in one plane of constant z, not a surface in space "
                             f"(in {path}): make the mesh flat, or fill the surface with tetrahedra")
        points = points[:, :2]
    return points, np.concatenate(cells[kind])


def _read(path: Path) -> tuple[np.ndarray, dict[str, list[np.ndarray]]]:
    """Points and, for each type of cell in the file, its blocks."""
    import meshio  # here, because only scenes with a mesh file need it and it loads slowly

    if not path.is_file():
        raise InputError(f"file must be an existing mesh file, not {path}")
    complaints = io.StringIO()
    try:
        with contextlib.redirect_stdout(complaints), contextlib.redirect_stderr(complaints):
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
