"""A scene as it was resolved, in one NumPy archive: whatever its mesh came from, it can be loaded again from there."""

from __future__ import annotations

from dataclasses import astuple
from pathlib import Path

import numpy as np

from golden.mesh.mesh import Mesh
from golden.physics.materials import Material
from golden.physics.scene import Phase, Scene
from golden.support.files import replaced

MESH = "points", "cells", "edges"
OBJECT = "edge_material", "mass", "gravity", "frames"
PHASE = "steps", "fixed", "velocity", "driven", "load"


def save(scene: Scene, path) -> None:
    """Write the scene with all of its arrays. The file appears whole or not at all."""
    arrays = {name: getattr(scene.mesh, name) for name in MESH} | {name: getattr(scene, name) for name in OBJECT}
    arrays |= {name: np.array([getattr(phase, name) for phase in scene.phases]) for name in PHASE}
    with replaced(Path(path)) as file:
        np.savez_compressed(
            file,
            allow_pickle=False,
            **arrays,
            name=scene.name,
            description=scene.description,
            dt=scene.dt,
            phases=[phase.name for phase in scene.phases],
            materials=[material.name for material in scene.materials],
            parameters=_numbers(scene.materials),
            switched=[bool(phase.materials) for phase in scene.phases],
            phase_parameters=[_numbers(phase.materials or scene.materials) for phase in scene.phases],
        )


def _numbers(materials: tuple[Material, ...]) -> list[tuple]:
    """What is behind their names, in the order of `Material`."""
    return [astuple(material)[1:] for material in materials]


def load(path) -> Scene:
    """The scene in a file that `save` wrote, equal to it but for its path, which is this file."""
    with open(path, "rb") as file, np.load(file) as archive:  # NumPy leaves a damaged file open
        kept = {name: archive[name] for name in archive}

    def materials(numbers):
        pairs = zip(kept["materials"].tolist(), numbers.tolist(), strict=True)
        return tuple(Material(name, *parameters) for name, parameters in pairs)

    brought = [
        materials(numbers) if switched else None
        for switched, numbers in zip(kept["switched"], kept["phase_parameters"], strict=True)
    ]
    phases = zip(kept["phases"].tolist(), *(kept[name] for name in PHASE), brought, strict=True)
    return Scene(
        name=str(kept["name"]),
        description=str(kept["description"]),
        path=Path(path),
        mesh=Mesh(*(kept[name] for name in MESH)),
        materials=materials(kept["parameters"]),
        dt=float(kept["dt"]),
        phases=tuple(Phase(name, int(steps), *arrays) for name, steps, *arrays in phases),
        **{name: kept[name] for name in OBJECT},
    )
