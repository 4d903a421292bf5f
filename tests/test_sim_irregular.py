"""Irregular meshes on the integer model against float64: no further apart than on grids."""

import golden_objects as objects
import numpy as np
import pytest

from environment import ROOT
from golden.mesh import mesh
from golden.physics import materials, stability
from golden.scene import load as scene
from sim.results.comparison import BOUND
from sim.run import run

BODIES = {
    "disc": {"radius": 0.05, "edge": 0.011},
    "ring": {"outer": 0.05, "inner": 0.025, "edge": 0.0085},
    "irregular": {"radius": 0.05, "edge": 0.011},
    "beam": {"size": [0.04, 0.1], "edge": 0.009},
    "ball": {"radius": 0.05, "edge": 0.021},
    "cylinder": {"radius": 0.035, "height": 0.08, "edge": 0.019},
    "beam-3d": {"size": [0.04, 0.05, 0.09], "edge": 0.019},
}
DENSITY = {2: 50.0, 3: 1000.0}
MATERIALS = {
    "rheological": materials.rheological("dough", 200.0, 1.0, 15.0),
    "rheological-force": materials.rheological_force("clay", 200.0, 1.0, f1=0.03, f2=0.15, c_max=400.0, c_min=10.0),
}


def pressed(name, material, seed):
    """Return a body whose lowest tenth is fixed: pressed from above by a sixth, held and let go."""
    body = mesh.filled(name.partition("-")[0], **BODIES[name], seed=seed)
    up = body.points[:, -1] - body.points[:, -1].min()
    low, high = up <= 0.1 * up.max(), up >= 0.9 * up.max()
    velocity = np.zeros(body.dim)
    velocity[-1] = -up.max() / 6 / 0.1

    def of(dt):
        phases = [
            objects.phase(body, round(0.1 / dt), low, (high, velocity), name="press"),
            objects.phase(body, round(0.05 / dt), low | high, name="hold"),
            objects.phase(body, round(0.1 / dt), low, name="release"),
        ]
        return objects.scene(body, MATERIALS[material], dt, phases, body.lumped_mass(DENSITY[body.dim]), every=10)

    return of(0.5 * stability.largest_dt(of(1e-3))[0])


def apart(one):
    """Return the largest distance of a node in integers from its place in float64, and its motion, by object's size."""
    float64, fixed = (run(one, backend) for backend in ("float", "fixed"))
    assert fixed.faults == {}
    distance = np.linalg.norm(fixed.trajectory.x - float64.trajectory.x, axis=2).max() / one.size
    return distance, np.linalg.norm(float64.trajectory.x - one.mesh.points, axis=2).max() / one.size


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("name", BODIES)
def test_irregular_bodies_stay_within_the_bounds(name, material, seed):
    one = pressed(name, material, seed)
    distance, moved = apart(one)
    print(
        f"{name} {material}: {len(one.mesh.points)} nodes, {len(one.mesh.edges)} edges, {one.steps} steps, "
        f"dt {one.dt:.1e}: {distance:.1e}"
    )
    assert moved > 0.05
    assert one.force_dependent == (material == "rheological-force")
    assert distance <= BOUND[one.force_dependent]


@pytest.mark.parametrize("name", ["ring", "ball", "bun"])
def test_shipped_irregular_scenes_stay_within_the_bounds(name):
    one = scene.load(ROOT / "scenes" / f"{name}.toml")
    distance, moved = apart(one)
    print(f"{name}: {distance:.1e}")
    assert moved > 0.1
    assert distance <= BOUND[one.force_dependent]


def test_bounds_are_those_of_the_claim():
    assert BOUND == {False: 1e-5, True: 5e-5}
