"""Load a scene file: one TOML file becomes a `golden.physics.scene.Scene`, checked before anything runs."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from golden.mesh.mesh import Mesh
from golden.physics import stability
from golden.physics.materials import Material
from golden.physics.scene import Phase, Scene
from golden.scene import schema
from golden.scene.assignment import assign_materials, replace_materials
from golden.scene.meshes import build_mesh
from golden.scene.regions import select_nodes, vector
from golden.support.errors import InputError


def load(path) -> Scene:
    """Return the scene in a file. Raises `InputError` with the file, the path of the key in it, and what it must be."""
    path = Path(path)
    try:
        return _scene(schema.convert(_document(path), schema.SceneFile), path)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _document(path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"the scene must be a readable file: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"the scene must be a TOML file: {error}") from None


def _scene(file: schema.SceneFile, path: Path) -> Scene:
    try:
        mesh = build_mesh(file.mesh, path.parent)
    except InputError as error:
        raise error.under("mesh") from None
    materials, edge_material = assign_materials(file.materials, mesh)
    if not file.phases:
        raise InputError("phases must hold at least one phase, not none")
    phases = _phases(file, mesh, materials)
    scene = Scene(
        name=file.name or path.stem,
        description=file.description,
        path=path,
        mesh=mesh,
        materials=materials,
        edge_material=edge_material,
        mass=_mass(file.mass, mesh),
        gravity=vector(file.gravity or [0.0] * mesh.dim, mesh.dim, "gravity"),
        dt=file.dt,
        phases=phases,
        frames=_frames(file.frames, phases),
    )
    stability.check(scene)
    return scene


def _mass(table: schema.Mass, mesh: Mesh) -> np.ndarray:
    """Return the nodes' masses (N,) in kg: they share the mass of each element, which goes by its area or volume."""
    if (table.density is None) == (table.total is None):
        given = "neither" if table.density is None else "both"
        raise InputError(f"mass must have one of density and total, not {given}")
    return mesh.lumped_mass(table.density or table.total / mesh.measure().sum())


def _phases(file: schema.SceneFile, mesh: Mesh, materials: tuple[Material, ...]) -> tuple[Phase, ...]:
    """Return the phases, each with the materials that it brings, or None."""
    phases = []
    for n, table in enumerate(file.phases):
        phase, path = _phase(table, mesh, file.dt, n), f"phases[{n}].materials"
        if table.materials and n == 0:
            raise InputError(f"{path} must not be there: the object begins with those of materials")
        if table.materials:
            materials = replace_materials(table.materials, materials, path)
            phase = replace(phase, materials=materials)
        phases.append(phase)
    return tuple(phases)


def _phase(table: schema.Phase, mesh: Mesh, dt: float, number: int) -> Phase:
    path, shape = f"phases[{number}]", mesh.points.shape
    steps = round(table.duration / dt)
    if steps == 0:
        raise InputError(f"{path}.duration must be at least one step of dt = {dt:g}, not {table.duration:g}")
    fixed, driven = np.zeros(shape[0], dtype=bool), np.zeros(shape[0], dtype=bool)
    velocity, load = np.zeros(shape), np.zeros(shape)
    for n, region in enumerate(table.fixed):
        fixed |= select_nodes(region, mesh, f"{path}.fixed[{n}]")
    for n, region in enumerate(table.driven):
        here = f"{path}.driven[{n}]"
        nodes = select_nodes(region, mesh, here)
        if (both := np.flatnonzero(nodes & (fixed | driven))).size:
            other = "fixed" if fixed[both[0]] else "driven a second time"
            raise InputError(f"{here} must not hold node {both[0]}, which is {other}")
        driven |= nodes
        velocity[nodes] = vector(region.velocity, mesh.dim, f"{here}.velocity")
    for n, region in enumerate(table.loads):
        nodes = select_nodes(region, mesh, f"{path}.loads[{n}]")
        load[nodes] += vector(region.force, mesh.dim, f"{path}.loads[{n}].force")
    phase = Phase(table.name or f"phase {number + 1}", steps, fixed, velocity, driven, load)
    _check_parts_held(phase, mesh, path)
    return phase


def _check_parts_held(phase: Phase, mesh: Mesh, path: str) -> None:
    """Refuse a mesh of several parts of which one is free: nothing connects it to the others, so it would fly away.

    An object in one piece may be free.
    """
    count, part = mesh.components()
    adrift = np.setdiff1d(part, part[phase.held])
    if count > 1 and adrift.size:
        node = np.flatnonzero(part == adrift[0])[0]
        raise InputError(
            f"{path} must fix or drive a node of each of the {count} parts of the mesh that no "
            f"edge joins, not leave the part of node {node} free"
        )


def _frames(table: schema.Frames, phases: tuple[Phase, ...]) -> np.ndarray:
    """Return the steps to keep: every so many, or a number of them evenly spread, and the ends of all phases."""
    if (table.every is None) == (table.count is None):
        given = "neither" if table.every is None else "both"
        raise InputError(f"frames must have one of every and count, not {given}")
    ends = np.cumsum([0] + [phase.steps for phase in phases])
    if table.every:
        wanted = np.arange(0, ends[-1], min(table.every, ends[-1]))
    else:
        wanted = np.round(np.linspace(0, ends[-1], min(table.count, ends[-1]) + 1)).astype(int)
    return np.union1d(wanted, ends)
