"""A single edge, pressed quickly, held and let go: the one object whose bounce-back has a closed form."""

from __future__ import annotations

import math

import numpy as np

from golden.mesh.mesh import Mesh
from golden.physics import stability
from golden.physics.materials import Material
from golden.physics.scene import Phase, Scene

LENGTH, DEPTH = 0.1, 0.025  # m, height and press of the blocks that ship
MASS = 5e-3  # kg of its upper end: light enough that nothing swings
DT = 2.5e-4  # s
PRESS, HOLD, RELEASE = 40, 400, 2400  # steps
EVERY = 5  # steps between two frames


def scene(name: str, material: Material) -> Scene:
    """Return the scene of an upright edge, fixed below. Raises `golden.support.errors.InputError` if the stable dt is
    below `DT`."""
    mesh = Mesh(np.array([[0.0, 0.0], [0.0, LENGTH]]), np.empty((0, 3), np.int64), np.array([[0, 1]]))
    foot, head, none = np.array([True, False]), np.array([False, True]), np.zeros(2, bool)
    still, down = np.zeros((2, 2)), np.array([[0.0, 0.0], [0.0, -DEPTH / (PRESS * DT)]])
    phases = (
        Phase("press", PRESS, foot, down, head, still),
        Phase("hold", HOLD, foot | head, still, none, still),
        Phase("release", RELEASE, foot, still, none, still),
    )
    steps = PRESS + HOLD + RELEASE
    frames = np.union1d(np.arange(0, steps + 1, EVERY), np.cumsum([phase.steps for phase in phases]))
    edge = Scene(
        name, "", None, mesh, (material,), np.zeros(1, np.int64), np.full(2, MASS), np.zeros(2), DT, phases, frames
    )
    stability.check(edge)
    return edge


def bounce_back(material: Material) -> float:
    """Return D q exp(-T / tau) in m, the way that the edge comes back after a sudden press and a hold of T.

    q = c2 / (c1 + c2) is the share of a quick press that goes into the Voigt part, tau = (c1 + c2) / k the time in
    which the damper takes it over. A press at constant speed counts half of its own time as hold: the remaining error
    is (press / tau)^2 / 24 of the bounce-back. Without a spring nothing comes back.
    """
    if material.k == 0:
        return 0.0
    q, sigma = material.rho_sigma(0.0)  # tau = 1 / (sigma k)
    return DEPTH * q * math.exp(-(HOLD + PRESS / 2) * DT * sigma * material.k)
