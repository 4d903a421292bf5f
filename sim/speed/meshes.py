"""The objects that are timed: blocks of soft dough hanging from their first layer, under a light pull."""

from __future__ import annotations

import re

import numpy as np

from golden.mesh import mesh
from golden.physics import materials
from golden.physics.scene import Phase, Scene
from golden.support.errors import InputError

MESHES = "9x9", "23x23", "5x5x5", "6x6x6", "8x8x8", "4x4x32"
"""Nodes along each axis."""

LAP = 10_000
"""Steps of a scene. The dough always flows a little, so that no number becomes too small for float32."""

DT = 2.5e-4  # s
PULL = 0.1  # m^2/s^2: acceleration along the last axis, times the length that hangs
CELLS = {  # dimensions -> m between nodes, kg/m^2 or kg/m^3, material
    2: (0.0125, 50.0, materials.rheological("dough", k=200.0, c1=3.0, c2=35.0)),
    3: (0.025, 1000.0, materials.rheological("dough", k=80.0, c1=2.0, c2=12.0)),
}


def scene(name: str) -> Scene:
    """Return the block with so many nodes along each axis: ``9x9`` of triangles, ``5x5x5`` of five tetrahedra a cell.

    Raises `InputError` for another kind of name.
    """
    if not re.fullmatch(r"[0-9]+x[0-9]+(x[0-9]+)?", name):
        raise InputError(f"meshes must be numbers of nodes like 9x9 or 5x5x5, not {name!r}")
    nodes = tuple(map(int, name.split("x")))
    spacing, density, dough = CELLS[len(nodes)]
    make = mesh.rectangle if len(nodes) == 2 else mesh.box
    block = make(nodes, tuple(spacing * (n - 1) for n in nodes))
    shape = block.points.shape
    hanging = Phase(
        "hang",
        LAP,
        fixed=block.points[:, -1] == 0,
        velocity=np.zeros(shape),
        driven=np.zeros(shape[0], bool),
        load=np.zeros(shape),
    )
    gravity = PULL / np.ptp(block.points[:, -1]) * np.eye(block.dim)[-1]
    return Scene(
        name=name,
        description="",
        path=None,
        mesh=block,
        materials=(dough,),
        edge_material=np.zeros(len(block.edges), int),
        mass=block.lumped_mass(density),
        gravity=gravity,
        dt=DT,
        phases=(hanging,),
        frames=np.array([0, LAP]),
    )
