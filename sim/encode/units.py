"""The circuit's units in SI, chosen for a scene.

A *size* is the object's size S and a *step* the time step h. Velocity, force and each material's trial force have a
full scale of their own, all powers of two, chosen for the scene: small enough that no bit is wasted on small time
steps, large enough that nothing saturates.
"""

from dataclasses import dataclass
from math import ceil, log2

import numpy as np

from golden.datapath.formats import Formats
from golden.physics.materials import Material
from golden.physics.scene import Scene

HEADROOM = 4.0
"""Factor by which the expected velocities and forces may be exceeded before anything saturates."""


@dataclass(frozen=True)
class Units:
    """One unit of each number of the circuit, in SI.

    Attributes
    ----------
    size : float
        Unit of length (m); ``centre`` is the origin.
    dt : float
        Unit of time (s).
    velocity_shift : int
        The velocity full scale is ``2**-velocity_shift`` sizes per step.
    force : float
        Full scale of an edge's force on a node (N), a power of two.
    trial : tuple of float
        Full scale of each material's trial force g (N), powers of two.
    """

    size: float
    centre: np.ndarray
    dt: float
    velocity_shift: int
    force: float
    trial: tuple[float, ...]

    @property
    def velocity(self) -> float:
        """Velocity full scale (m/s)."""
        return 2.0**-self.velocity_shift * self.size / self.dt


def choose(scene: Scene, formats: Formats) -> Units:
    """Return units that fit the scene's drives, loads, stiffnesses and masses with `HEADROOM`, at its start."""
    points = scene.mesh.points
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    fastest = expected_speed(scene) * HEADROOM
    lowest = 1 - formats.displacement.int_bits  # a step must fit the displacement format
    shift = max(lowest, int(-np.ceil(log2(fastest * scene.dt / scene.size)))) if fastest else lowest
    velocity = 2.0**-shift * scene.size / scene.dt
    trials = [trials_of(scene, materials, velocity) for materials in scene.material_sets]
    shares = [
        largest_share(m) * g
        for materials, trial in zip(scene.material_sets, trials, strict=True)
        for m, g in zip(materials, trial, strict=True)
    ]
    loads = [np.abs(p.load).max() + scene.mass.max() * np.abs(scene.gravity).max() for p in scene.phases]
    return Units(scene.size, centre, scene.dt, shift, full_scale(max(*shares, *loads)), trials[0])


def trials_of(scene: Scene, materials: tuple[Material, ...], velocity: float) -> tuple[float, ...]:
    """Return `Units.trial` for these materials."""
    return tuple(full_scale(expected_trial(scene, m, velocity)) for m in materials)


def expected_speed(scene: Scene) -> float:
    """Return an estimate of the largest speed (m/s): of the drives, of a fall through the object's size, of the recoil
    from the strain that drives and loads can cause."""
    driven = [np.linalg.norm(p.velocity, axis=1).max(initial=0.0) for p in scene.phases]
    travel = sum(speed * p.steps * scene.dt for speed, p in zip(driven, scene.phases, strict=True))
    stiffest = max(m.k for materials in scene.material_sets for m in materials)
    recoil = min(travel / scene.size, 1.0) * longest(scene) * np.sqrt(stiffest / scene.mass.min())
    fall = np.sqrt(2 * np.linalg.norm(scene.gravity) * scene.size)
    pushed = max(np.linalg.norm(p.load, axis=1).max() / scene.mass.min() * scene.dt for p in scene.phases)
    return float(max(*driven, recoil, fall, pushed))


def expected_trial(scene: Scene, material: Material, velocity: float) -> float:
    """Return the trial force (N) of the longest edge, stretched by half, at half of the velocity full scale."""
    return material.k * longest(scene) / 2 + material.c1 * velocity / 2


def longest(scene: Scene) -> float:
    """Return the length of the longest edge (m)."""
    i, j = scene.mesh.edges.T
    return float(np.linalg.norm(scene.mesh.points[j] - scene.mesh.points[i], axis=1).max())


def largest_share(material: Material) -> float:
    """Return the largest rho: the part of the trial force that an edge carries."""
    rho, _ = material.rho_sigma(0.0)
    return float(rho)


def full_scale(x: float) -> float:
    """Return the smallest power of two that is at least x."""
    return 2.0 ** ceil(log2(x)) if x > 0 else 1.0
