"""Materials of elements and edges, from the tables of a scene file."""

from __future__ import annotations

from inspect import Parameter, signature
from typing import Any

import numpy as np

from golden.mesh.mesh import Mesh
from golden.physics.materials import PRESETS, Material
from golden.scene import schema
from golden.scene.regions import Region, select_cells
from golden.support.errors import InputError


def assign_materials(tables: dict[str, Any], mesh: Mesh) -> tuple[tuple[Material, ...], np.ndarray]:
    """Return the materials in the file's order, and the index of each edge's material (E,).

    A material without a region gets the elements that the others leave. An edge between elements of different
    materials gets the one that comes first in the file. Raises `InputError` when a parameter is wrong or an element
    does not have exactly one material.
    """
    if not tables:
        raise InputError("materials must hold at least one material, not none")
    owner = np.full(len(mesh.cells), -1)
    materials, rest = [], None  # index of the material that gets what the others leave
    for index, (name, table) in enumerate(tables.items()):
        path = f"materials.{name}"
        materials.append(_material(name, table, path))
        if "region" not in table:
            if rest is not None:
                raise InputError(
                    f"{path}.region must be given, as materials.{materials[rest].name} already has what "
                    "the others leave"
                )
            rest = index
            continue
        region = schema.convert(table["region"], Region, f"{path}.region")
        cells = select_cells(region, mesh, f"{path}.region")
        if (taken := np.flatnonzero(cells & (owner >= 0))).size:
            other = materials[owner[taken[0]]].name
            raise InputError(
                f"{path}.region must not overlap materials.{other}.region: both hold {_describe_cells(mesh, taken)}"
            )
        owner[cells] = index
    if rest is not None:
        if (owner >= 0).all():
            raise InputError(f"materials.{materials[rest].name} must have an element, but the others leave none")
        owner[owner < 0] = rest
    if (left := np.flatnonzero(owner < 0)).size:
        raise InputError(f"materials must cover every element, but none holds {_describe_cells(mesh, left)}")
    return tuple(materials), _per_edge(owner, mesh)


def replace_materials(tables: dict[str, Any], materials: tuple[Material, ...], path: str) -> tuple[Material, ...]:
    """Return the materials after those in the tables of a phase, found at ``path``, have replaced theirs by name.

    Raises `InputError` for a name that the object doesn't have, and for a wrong parameter.
    """
    names = [material.name for material in materials]
    for name, table in tables.items():
        if name not in names:
            raise schema.unknown_key(f"{path}.{name}", names)
        if "region" in table:
            raise InputError(f"{path}.{name}.region must not be there: a material is another one where it is")
        materials = tuple(_material(name, table, f"{path}.{name}") if m.name == name else m for m in materials)
    return materials


def _material(name: str, table: Any, path: str) -> Material:
    if not isinstance(table, dict):
        raise InputError(f"{path} must be a table, not {schema.format_value(table)}")
    if "preset" not in table:
        raise InputError(f"{path}.preset must be given: one of {', '.join(PRESETS)}")
    if table["preset"] not in tuple(PRESETS):
        found = schema.format_value(table["preset"])
        raise InputError(f"{path}.preset must be one of {', '.join(PRESETS)}, not {found}")
    preset = PRESETS[table["preset"]]
    expected = dict(list(signature(preset).parameters.items())[1:])  # after the name
    given = {key: value for key, value in table.items() if key not in ("preset", "region")}
    for key in given:
        if key not in expected:
            raise schema.unknown_key(f"{path}.{key}", ["preset", "region", *expected])
    for key, parameter in expected.items():
        if parameter.default is Parameter.empty and key not in given:
            raise InputError(f"{path}.{key} must be given")
    try:
        return preset(name, **given)
    except InputError as error:
        raise error.under(path) from None


def _per_edge(owner: np.ndarray, mesh: Mesh) -> np.ndarray:
    """Return the smallest index of a material among the elements around each edge (E,)."""
    first = np.full(len(mesh.edges), np.iinfo(np.int64).max)
    np.minimum.at(first, mesh.cell_edges(), owner[:, None])
    return first


def _describe_cells(mesh: Mesh, cells: np.ndarray) -> str:
    """Return the index and the centroid of the first of some elements, and how many more there are."""
    centre = ", ".join(f"{x:.6g}" for x in mesh.points[mesh.cells[cells[0]]].mean(axis=0))
    more = f" and {len(cells) - 1} more" if len(cells) > 1 else ""
    return f"element {cells[0]} around [{centre}]{more}"
