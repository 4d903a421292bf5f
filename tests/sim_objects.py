"""Small scenes for the tests of co-simulation, and a stand-in for the simulated circuit."""

from contextlib import contextmanager
from typing import ClassVar

import golden_objects as objects
import numpy as np

from golden.datapath.machine import Machine
from golden.mesh import mesh
from golden.physics import materials
from hw.parameters import Parameters
from sim.backends.rtl import RtlBackend

DT = 2e-4
MATERIALS = {
    "viscoelastic": materials.viscoelastic("gel", 200.0, 0.5),
    "plastic": materials.plastic("clay", 2.0),
    "rheological": materials.rheological("dough", 200.0, 0.5, 20.0),
    "rheological-force": materials.rheological_force(
        "dough", 200.0, 0.5, f1=0.05, f2=0.5, c_max=200.0, c_min=2.0, a_min=0.1, a_max=0.9, a0=0.5
    ),
    "plastic-force": materials.plastic_force("clay", 5.0, f1=0.05, f2=0.5, c_max=1.0, c_min=0.05),
}
MESHES = {2: mesh.rectangle((4, 3), (0.1, 0.08)), 3: mesh.box((3, 3, 3), (0.1, 0.08, 0.06))}


def block(material="rheological", dim=2, steps=(40, 20, 30), every=6, **kwargs):
    """Return a block pressed by a tenth of its height, held and let go."""
    m = MESHES[dim]
    depth = np.ptp(m.points[:, -1]) / 10
    phases = objects.press_hold_release(m, depth, (steps[0], DT), *steps[1:])
    return objects.scene(
        m,
        MATERIALS.get(material, material),
        DT,
        phases,
        **{"mass": 0.01 + 0.001 * (np.arange(len(m.points)) % 3), "every": every} | kwargs,
    )


class Standin(Machine):
    """The integer model in the circuit's place."""

    def __init__(self, image, parameters: Parameters | None = None):
        super().__init__(image)
        self.parameters, self.cycles = parameters, 0

    def step(self, steps: int = 1):
        super().step(steps)
        self.cycles += 100 * steps


def in_place_of_the_circuit(machine=Standin):
    """Return a backend to register in place of `sim.backends.rtl.RtlBackend`, which keeps its settings in ``asked``."""

    class StandinBackend(RtlBackend):
        asked: ClassVar[list] = []

        @contextmanager
        def open(self, encoded):
            self.asked.append((self.lanes, self.updates, self.waves))
            yield machine(encoded.image, self.parameters)

    return StandinBackend
