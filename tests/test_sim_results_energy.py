"""sim.results.energy: the work put in is the energy in the object plus the heat of the dampers."""

import golden_objects as objects
import numpy as np
import pytest
from sim_objects import DT, MATERIALS, MESHES, block

from golden.physics.model import Model
from sim.results import energy
from sim.run import run

LINEAR = "viscoelastic", "plastic", "rheological"


def heat(scene):
    """Return (F,) the heat (J) of an object's dampers, from their own forces and rates, step by step."""
    model, power, total, kept = Model(scene), None, 0.0, [0.0]
    for phase in scene.phases:
        model.begin(phase)
        power = _power(model)
        for _ in range(phase.steps):
            model.step()
            before, power = power, _power(model)
            total += scene.dt * (before + power) / 2
            kept.append(total)
    return np.array(kept)[scene.frames]


def _power(model):
    d = model.x[model.j] - model.x[model.i]
    length = np.linalg.norm(d, axis=1)
    ldot = ((model.v[model.j] - model.v[model.i]) * d).sum(axis=1) / length
    force, a_rate = model.edge_law(length, ldot, model.a)
    voigt = a_rate * length + model.a * ldot
    return model.c1 @ voigt**2 - force @ (ldot - voigt)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("material", ["viscoelastic", "rheological", "rheological-force"])
def test_missing_energy_has_become_heat(material, dim):
    scene = block(material, dim, steps=(200, 50, 300), every=1, mass=0.01, gravity=(-9.81, *[0.0] * (dim - 1)))
    result = energy.energies(scene, run(scene, "float").trajectory)
    expected = heat(scene)
    assert expected[-1] > 0
    np.testing.assert_allclose(result["dissipated"], expected, atol=1e-3 * expected[-1])


def test_the_device_gives_the_nodes_their_speed():
    """Driven nodes are at rest before frame 0 and move at it; the device takes their energy when it stops them."""
    scene = block("plastic", steps=(20, 5, 5), every=1)
    result, press = energy.energies(scene, run(scene, "float").trajectory), scene.phases[0]
    moving = (press.velocity[press.driven] ** 2).sum(axis=1) @ scene.mass[press.driven] / 2
    assert result["work"][0] == result["kinetic"][0] == pytest.approx(moving, rel=1e-12)
    assert result["dissipated"][0] == 0
    assert result["work"][21] - result["work"][20] == pytest.approx(-moving, rel=1e-9)


@pytest.mark.parametrize("material", LINEAR)
def test_heat_does_not_come_back(material):
    scene = block(material, steps=(200, 50, 300), every=10)
    result = energy.energies(scene, run(scene, "fixed").trajectory)
    lost = np.diff(result["dissipated"])
    assert lost.min() > -1e-3 * result["dissipated"][-1] and result["dissipated"][-1] > 0
    assert all(result[name].min() >= 0 for name in ("kinetic", "elastic"))


def test_the_work_of_a_load_is_force_times_distance():
    """A constant force on a free object: its work is force times distance, and all of it is accounted for."""
    m = MESHES[2]
    scene = objects.scene(
        m,
        MATERIALS["viscoelastic"],
        DT,
        [objects.phase(m, 200, load=(objects.top(m), (0.3, 0.2)))],
        mass=0.01,
        every=50,
    )
    trajectory = run(scene, "float").trajectory
    result = energy.energies(scene, trajectory)
    way = (trajectory.x[-1] - trajectory.x[0])[objects.top(m)]
    assert result["work"][-1] == pytest.approx((way @ [0.3, 0.2]).sum(), rel=1e-12)
    assert result["gravity"].any() == 0
    np.testing.assert_allclose(result["dissipated"], heat(scene), atol=1e-3 * result["work"][-1])


def test_the_energy_of_gravity_is_weight_times_height():
    m = MESHES[3]
    scene = objects.scene(m, MATERIALS["plastic"], DT, [objects.phase(m, 200)], mass=0.02, gravity=(0, 0, -9.81))
    trajectory = run(scene, "float").trajectory
    result = energy.energies(scene, trajectory)
    fall = 9.81 * trajectory.t**2 / 2
    np.testing.assert_allclose(result["gravity"], -0.02 * len(m.points) * 9.81 * fall, rtol=1e-9)
    np.testing.assert_allclose(result["kinetic"], -result["gravity"], rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(result["dissipated"], 0, atol=1e-12)


@pytest.mark.parametrize("material", ["rheological", "plastic-force"])
def test_the_forces_of_the_edges_add_up_to_the_reactions(material):
    scene = block(material, 3, steps=(40, 20, 30))
    trajectory = run(scene, "float").trajectory
    forces = energy.edge_forces(scene, trajectory)
    assert forces.shape == trajectory.a.shape
    i, j = trajectory.edges.T
    for frame in range(len(trajectory.t)):
        d = trajectory.x[frame, j] - trajectory.x[frame, i]
        push = forces[frame, :, None] * d / np.linalg.norm(d, axis=1)[:, None]
        total = np.zeros_like(trajectory.x[0])
        np.add.at(total, j, push)
        np.subtract.at(total, i, push)
        held = trajectory.reaction[frame].any(axis=1)
        np.testing.assert_allclose(total[held], -trajectory.reaction[frame][held], atol=1e-12)
    pressed = forces[len(forces) // 3]
    assert pressed.max() > abs(pressed.min()) > 0  # pressed: most of all it pushes back
