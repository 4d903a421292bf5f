"""Build the mesh that a scene file or a command line asks for."""

from __future__ import annotations

from pathlib import Path

from msgspec.structs import asdict

from golden.mesh import mesh
from golden.mesh.mesh import Mesh
from golden.scene import schema


def build_mesh(table: schema.Mesh, folder: Path) -> Mesh:
    """Return the mesh of a table; file names are relative to the folder. Raises `golden.support.errors.InputError`
    naming the table's key."""
    match table:
        case schema.Rectangle():
            return mesh.rectangle(table.nodes, table.size)
        case schema.Box():
            return mesh.box(table.nodes, table.size, table.tetrahedra)
        case schema.File():
            return mesh.read(folder / table.file, table.scale)
    return mesh.filled(table.__struct_config__.tag, **asdict(table))
