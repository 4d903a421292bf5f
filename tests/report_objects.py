"""Small scenes whose runs and pages the tests of the report share."""

from dataclasses import replace

import golden_objects as objects
from sim_objects import DT, MATERIALS, MESHES, block

FLAT = replace(block("rheological-force", steps=(10, 5, 10)), name="../<b>soft & wet</b>", description="1 < 2 & 3")
SOLID = replace(block("rheological", 3, steps=(60, 20, 60), every=4), name="solid")
WEIGHT = replace(
    objects.scene(
        MESHES[2],
        MATERIALS["viscoelastic"],
        DT,
        [objects.phase(MESHES[2], 12, objects.bottom(MESHES[2]), name="stand")],
        0.01,
        (0, -9.81),
        every=4,
    ),
    name="weight",
)
