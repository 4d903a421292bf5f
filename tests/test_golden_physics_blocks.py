"""The paper's Figures 1 to 6 and section 6 on whole objects, in numbers."""

import numpy as np
import pytest
from golden_objects import bottom, press_hold_release, scene, top

from golden.mesh import mesh
from golden.physics import stability
from golden.physics.materials import plastic, plastic_force, rheological, rheological_force, viscoelastic
from golden.physics.model import simulate

SIDE = 0.1  # m
MATERIALS = {
    "viscoelastic": viscoelastic("gum", k=50.0, c1=1.0),
    "plastic": plastic("clay", c_damper=1.0),
    "rheological": rheological("dough", k=20.0, c1=2.0, c2=2.0),  # q = 1/2, tau = 0.2 s
}


def pressed(grid, material, depth, hold, release, node_mass=2e-3):
    """Return the run of a block on fixed ground, pressed by ``depth`` in 0.05 s, held, let go (s, kg)."""
    dt = 2.5e-4
    phases = press_hold_release(grid, depth, (200, dt), round(hold / dt), round(release / dt))
    problem = scene(grid, material, dt, phases, node_mass)
    stability.check(problem)
    return simulate(problem)


def heights(grid, run):
    return run.x[:, top(grid), -1].mean(axis=1)


@pytest.mark.parametrize("name", MATERIALS)
def test_a_block_recovers_as_in_figure_1(name):
    grid, depth = mesh.rectangle((5, 5), (SIDE, SIDE)), 0.2 * SIDE
    run = pressed(grid, MATERIALS[name], depth, hold=0.2, release=0.8)
    initial, _, deformed, stationary = heights(grid, run)
    assert deformed == pytest.approx(initial - depth, abs=1e-12)
    recovered = (stationary - deformed) / depth
    # the slowest mode of the viscoelastic block has a damping of 75 / s and a stiffness of 3750 / s^2: it
    # decays at more than 30 / s; during the hold, with the top fixed too, at more than 60 / s
    if name == "viscoelastic":
        assert abs(run.x[-1] - run.x[0]).max() < depth * np.exp(-0.8 * 30)
    elif name == "plastic":  # the inner nodes were not quite at rest when it was let go
        assert abs(run.x[-1] - run.x[-2]).max() < depth * np.exp(-0.2 * 60)
    else:  # one edge recovers q exp(-(T + t / 2) / tau), and so does the block, except that its edges turn
        assert recovered == pytest.approx(0.5 * np.exp(-(0.2 + 0.025) / 0.2), rel=0.1)


@pytest.mark.parametrize("tetrahedra", [5, 6])
@pytest.mark.parametrize("name", MATERIALS)
def test_pressing_the_top_makes_the_sides_bulge_as_in_figure_6(name, tetrahedra):
    grid = mesh.box((4, 4, 5), (SIDE / 2, SIDE / 2, SIDE), tetrahedra)
    run = pressed(grid, MATERIALS[name], 0.1 * SIDE, hold=0.02, release=2.5e-4)
    for axis in (0, 1):
        left, right = (grid.points[:, axis] == side for side in (0, SIDE / 2))
        width = [x[right, axis].mean() - x[left, axis].mean() for x in run.x]
        assert width[1] > 1.01 * width[0] and width[2] > 1.01 * width[0]


GROUND = mesh.rectangle((5, 5), (SIDE, SIDE))
NODE = 0.01  # kg; the columns carry 0.5 N each
SOFT, STIFF = 2.0, 100.0  # N s/m
STRONG = dict(f1=2.0, f2=4.0, c_max=STIFF, c_min=SOFT)


def under_gravity(material, dt, time=0.12):
    """Return the part of its height that a block loses standing on the ground for ``time``."""
    grid = GROUND
    phases = press_hold_release(grid, 0.0, (1, dt), 1, round(time / dt))[2:]
    problem = scene(grid, material, dt, phases, NODE, gravity=(0.0, -9.81))
    stability.check(problem)
    initial, final = heights(grid, simulate(problem))
    return (initial - final) / SIDE


@pytest.mark.parametrize(
    ("linear", "force_dependent", "dt"),
    [
        (rheological("dough", 500.0, 5.0, SOFT), rheological_force("loaf", 500.0, 5.0, **STRONG), 5e-4),
        (plastic("clay", SOFT), plastic_force("loam", 10 * STIFF, **STRONG), 2e-5),
    ],
    ids=["rheological", "plastic"],
)
def test_a_block_holds_under_gravity_only_with_a_force_dependent_damper(linear, force_dependent, dt):
    """A linear damper lets the block collapse; one as soft at large forces, stiff at small ones, does not."""
    assert under_gravity(linear, 5e-4) > 0.3
    assert under_gravity(force_dependent, dt) < 0.05


def test_what_holds_under_gravity_can_still_be_deformed():
    """Pressing exceeds f1, and the block keeps more of it than with the stiff damper at every force."""
    kept = {}
    loaf, brick = rheological_force("loaf", 900.0, 5.0, **STRONG), rheological("brick", 900.0, 5.0, STIFF)
    for material in (loaf, brick):
        run = pressed(GROUND, material, 0.3 * SIDE, hold=0.001, release=0.4, node_mass=NODE)
        kept[material.name] = (heights(GROUND, run)[0] - heights(GROUND, run)[-1]) / (0.3 * SIDE)
    assert kept["loaf"] > 0.5 and kept["loaf"] > 2 * kept["brick"]


def test_reactions_balance_a_standing_block():
    """At rest the ground carries the weight: the sum of the reactions is total mass times gravity."""
    gum = viscoelastic("gum", k=500.0, c1=2.0)
    phases = press_hold_release(GROUND, 0.0, (1, 1e-3), 1, 2000)[2:]
    run = simulate(scene(GROUND, gum, 1e-3, phases, NODE, gravity=(0.0, -9.81)))
    weight = 25 * NODE * 9.81
    assert abs(run.v[-1]).max() < 1e-9
    np.testing.assert_allclose(run.reaction[-1].sum(axis=0), [0, weight], atol=1e-6 * weight)
    assert (run.reaction[:, ~bottom(GROUND)] == 0).all()
    assert heights(GROUND, run)[-1] < heights(GROUND, run)[0]
