"""A resolved scene in one NumPy archive: it can be loaded from there wherever its mesh came from."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import numpy as np

from golden.mesh.mesh import Mesh
from golden.physics import dampers
from golden.physics.materials import Material
from golden.physics.scene import Phase, Scene
from golden.support.files import atomic_file


def save(scene: Scene, path) -> None:
    """Write the scene with all of its arrays. The file appears whole or not at all."""
    mesh, phases = scene.mesh, scene.phases
    with atomic_file(Path(path)) as file:
        np.savez_compressed(
            file,
            allow_pickle=False,
            name=scene.name,
            description=scene.description,
            dt=scene.dt,
            points=mesh.points,
            cells=mesh.cells,
            edges=mesh.edges,
            materials=_text(scene.materials),
            edge_material=scene.edge_material,
            mass=scene.mass,
            gravity=scene.gravity,
            frames=scene.frames,
            phases=[phase.name for phase in phases],
            steps=[phase.steps for phase in phases],
            fixed=[phase.fixed for phase in phases],
            velocity=[phase.velocity for phase in phases],
            driven=[phase.driven for phase in phases],
            load=[phase.load for phase in phases],
            phase_materials=[_text(phase.materials) for phase in phases],
        )


def load(path) -> Scene:
    """Return the scene in a file that `save` wrote, equal to it but for its path, which is this file."""
    with open(path, "rb") as file, np.load(file) as archive:  # NumPy leaves a damaged file open
        kept = {name: archive[name] for name in archive}
    phases = zip(
        kept["phases"].tolist(),
        kept["steps"].tolist(),
        kept["fixed"],
        kept["velocity"],
        kept["driven"],
        kept["load"],
        map(_materials, kept["phase_materials"].tolist()),
        strict=True,
    )
    return Scene(
        name=str(kept["name"]),
        description=str(kept["description"]),
        path=Path(path),
        mesh=Mesh(kept["points"], kept["cells"], kept["edges"]),
        materials=_materials(str(kept["materials"])),
        edge_material=kept["edge_material"],
        mass=kept["mass"],
        gravity=kept["gravity"],
        dt=float(kept["dt"]),
        phases=tuple(Phase(*phase) for phase in phases),
        frames=kept["frames"],
    )


def _text(materials: tuple[Material, ...] | None) -> str:
    """Return the materials as JSON: their parameters, those of their dampers, and which law each damper has."""
    tables = materials and [asdict(material) | {"law": type(material.damper).__name__} for material in materials]
    return json.dumps(tables, default=float)


def _materials(text: str) -> tuple[Material, ...] | None:
    """Return the materials in JSON of `_text`."""
    tables = json.loads(text)
    return tables and tuple(
        Material(**table | {"damper": dampers.restore(table.pop("law"), table["damper"])}) for table in tables
    )
