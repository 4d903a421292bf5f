"""The largest stable step against closed forms and against runs that blow up, and the error message."""

import re
from dataclasses import replace

import numpy as np
import pytest
from golden_objects import bottom, line, phase, press_hold_release, scene, top
from scipy.spatial import Delaunay

from golden.mesh import mesh
from golden.physics import stability
from golden.physics.dampers import Linear
from golden.physics.materials import Material, plastic, plastic_force, rheological, rheological_force, viscoelastic
from golden.physics.model import Model, simulate
from golden.support.errors import InputError

SIDE = 0.1  # m
MARGIN = stability.HALF_DISC * stability.TURNING
inf = np.inf


def irregular(dim, per_side):
    """Return a Delaunay mesh of a grid's points moved at random; always the same."""
    grid = np.stack(np.meshgrid(*dim * [np.arange(per_side)]), axis=-1).reshape(-1, dim)
    points = grid + np.random.default_rng(5).uniform(-0.3, 0.3, grid.shape)
    points[:, -1] = np.maximum(points[:, -1], 0)
    return mesh.from_cells(points * SIDE / per_side, Delaunay(points).simplices)


def at_rest(grid, material, mass=2e-3, dt=1.0, edge_material=0):
    return scene(grid, material, dt, [phase(grid, 1, bottom(grid))], mass, edge_material=edge_material)


def half_and_half(grid):
    """Return material 0 for edges of the left half, 1 for those of the right half."""
    return (grid.points[grid.edges, 0].mean(axis=1) > SIDE / 2).astype(int)


SQUARE, CUBE = mesh.rectangle((6, 6), (SIDE, SIDE)), mesh.box((4, 4, 4), (SIDE, SIDE, SIDE))
CASES = {
    "2-D rheological": at_rest(SQUARE, rheological("dough", 100.0, 2.0, 2.0)),
    "2-D viscoelastic, nearly undamped": at_rest(SQUARE, viscoelastic("gum", 100.0, 0.01)),
    "2-D viscoelastic, critically damped": at_rest(SQUARE, viscoelastic("gum", 1000.0, 0.65)),
    "2-D ratio faster than the nodes": at_rest(SQUARE, rheological("maxwell", 500.0, 0.0, 1e-3)),
    "2-D two materials": at_rest(
        SQUARE, [viscoelastic("gum", 3e3, 0.01), plastic("clay", 3.0)], edge_material=half_and_half(SQUARE)
    ),
    "irregular 2-D plastic, force-dependent": at_rest(
        irregular(2, 6), plastic_force("loam", 500.0, f1=0.01, f2=0.05, c_max=5.0, c_min=0.1)
    ),
    "irregular 3-D rheological, force-dependent": at_rest(
        irregular(3, 4), rheological_force("loaf", 100.0, 5.0, f1=0.01, f2=0.05, c_max=5.0, c_min=0.1)
    ),
    "3-D plastic": at_rest(CUBE, plastic("clay", 3.0)),
    "3-D viscoelastic, six tetrahedra": at_rest(
        mesh.box((4, 4, 3), (SIDE, SIDE, SIDE), 6), viscoelastic("gum", 100.0, 0.1)
    ),
}


def blows_up(problem, dt, steps=200):
    """Return True if a kick of 1e-9 of the size per step grows ten thousand times (coasting, it grows 200 times)."""
    model = Model(replace(problem, dt=dt))
    kick = 1e-9 * problem.size / dt * np.random.default_rng(6).normal(size=model.v.shape)
    model.v = np.where(model.held, 0, kick)
    with np.errstate(all="ignore"):
        for _ in range(steps):
            model.step()
    moved = abs(model.x - problem.mesh.points).max() / problem.size
    return not max(moved, abs(model.a - problem.per_edge(lambda m: m.a0)).max()) < 1e-5


@pytest.mark.parametrize("name", CASES)
def test_bound_lies_within_a_factor_of_2_below_the_step_that_blows_up(name):
    bound, _, _ = stability.largest_dt(CASES[name])
    low, high = 1.0, 2.0
    assert not blows_up(CASES[name], low * bound)
    assert blows_up(CASES[name], high * bound)
    while high - low > 0.05:
        middle = (low + high) / 2
        low, high = (low, middle) if blows_up(CASES[name], middle * bound) else (middle, high)
    print(f"{name}: blows up at {high:.2f} times the bound of {bound:.3g} s")
    # the half-disc lies within the stability region, whose farthest point is 2.96: the bound is not too careful
    assert MARGIN * low < 2.96 + 0.05 * MARGIN


@pytest.mark.parametrize(
    "name", ["2-D rheological", "2-D two materials", "3-D plastic", "irregular 2-D plastic, force-dependent"]
)
def test_pressing_at_the_bound_is_as_good_as_with_half_the_step(name):
    """Edges turn and forces go through the whole damper law: it must be stable, and is then accurate."""
    problem = CASES[name]
    bound, _, _ = stability.largest_dt(problem)
    shapes = []
    for finer in (1, 2):
        dt, steps = bound / finer, 80 * finer
        phases = press_hold_release(problem.mesh, 0.3 * SIDE, (steps, dt), steps, steps)
        frames = steps * np.arange(4)
        shapes.append(simulate(replace(problem, dt=dt, phases=tuple(phases), frames=frames)).x)
    assert abs(shapes[0] - shapes[1]).max() < 1e-3 * SIDE


def test_half_disc_lies_within_the_stability_region_of_runge_kutta():
    radius, angle = np.meshgrid(np.linspace(0, stability.HALF_DISC, 300), np.linspace(np.pi / 2, np.pi, 300))
    z = radius * np.exp(1j * angle)
    growth = 1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24
    assert (abs(growth) <= 1 + 1e-12).all()


K, C1, C2, MASS = 300.0, 2.0, 3.0, 0.05
SIGMA, RHO = 1 / (C1 + C2), C2 / (C1 + C2)


@pytest.mark.parametrize(
    ("material", "damping", "stiffness", "reason"),
    [
        (viscoelastic("m", K, 0.0), 0, K / MASS, "stiffness"),
        (viscoelastic("m", K, C1), C1 / MASS, K / MASS, "stiffness"),
        (viscoelastic("m", K, 50.0), 50 / MASS, K / MASS, "damping"),
        (plastic("m", C1), C1 / MASS, 0, "damping"),
        (rheological("m", K, C1, C2), RHO * C1 / MASS + K * SIGMA, RHO * K / MASS, "stiffness"),
        (rheological("m", K, C1, C2, 0.4, 0.4, 0.4), RHO * C1 / MASS, RHO * K * 0.4 / MASS, "stiffness"),
        (rheological("m", 20.0, C1, C2), RHO * C1 / MASS + 20 * SIGMA, RHO * 20 / MASS, "stiffness"),
        (rheological("m", 20.0, C1, C2, a_min=0.3), RHO * C1 / MASS, RHO * 20 * 0.3 / MASS, "damping"),
        (rheological("m", 20.0, C1, C2, a_max=0.5), RHO * C1 / MASS, RHO * 20 * 0.5 / MASS, "damping"),
        (
            rheological("m", K, C1, 1e-3, a_max=0.5),
            C1 * 1e-3 / (C1 + 1e-3) / MASS + K / (C1 + 1e-3),
            K * 1e-3 / (C1 + 1e-3) / MASS,
            "stiffness",
        ),
    ],
)
def test_one_edge_has_the_roots_of_its_quadratic(material, damping, stiffness, reason):
    """lambda^2 + (rho c1 / m + k sigma) lambda + rho k / m; while a is held, no k sigma and rho k a / m."""
    fastest = abs(np.roots([1, damping, stiffness])).max()
    problem = scene(line(), material, 1.0, [phase(line(), 1, [0])], MASS)
    dt, name, because = stability.largest_dt(problem)
    assert dt == pytest.approx(MARGIN / fastest, rel=1e-9)
    assert (name, because) == ("m", reason)


def test_a_soft_damper_counts_with_the_slope_of_its_law():
    """Just below f2 the damper yields at d(f / c2) / df = (1 + B f2) / c_min."""
    f1, f2, c_max, c_min = 0.1, 0.3, 20.0, 0.01
    law = rheological_force("loaf", K, 0.0, f1=f1, f2=f2, c_max=c_max, c_min=c_min)
    problem = scene(line(), law, 1.0, [phase(line(), 1, [0, 1])], MASS)
    c2 = law.damper.c2
    slope = (f2 / c2(f2) - (f2 - 1e-7) / c2(f2 - 1e-7)) / 1e-7
    dt, _, reason = stability.largest_dt(problem)
    assert dt == pytest.approx(MARGIN / (K * slope), rel=1e-4)
    assert reason == "stiffness"


def test_the_largest_step_scales_with_masses_and_coefficients():
    """dt goes like mass / c where damping limits, and like the root of mass / k where stiffness does."""
    for material, power in ((lambda s: plastic("m", s), 1), (lambda s: viscoelastic("m", s, 0.0), 0.5)):
        base = stability.largest_dt(at_rest(CUBE, material(2.0)))[0]
        stronger = stability.largest_dt(at_rest(CUBE, material(8.0)))[0]
        heavier = stability.largest_dt(at_rest(CUBE, material(2.0), 8e-3))[0]
        assert (stronger, heavier) == pytest.approx((base / 4**power, base * 4**power), rel=1e-3)


@pytest.mark.parametrize("name", ["2-D two materials", "3-D plastic", "2-D viscoelastic, nearly undamped"])
def test_iteration_and_full_eigenvalues_agree(monkeypatch, name):
    """Large objects get one eigenvalue by iteration, small ones all of them."""
    iterated = stability.largest_dt(CASES[name])
    monkeypatch.setattr(stability, "DENSE", 10**6)
    full = stability.largest_dt(CASES[name])
    assert iterated[0] == pytest.approx(full[0], rel=1e-3) and iterated[1:] == full[1:]


def test_limiting_material_is_named():
    gum, clay = viscoelastic("gum", 3e3, 0.01), plastic("clay", 3.0)
    split = half_and_half(SQUARE)
    assert stability.largest_dt(at_rest(SQUARE, [gum, clay], edge_material=split))[1:] == ("clay", "damping")
    assert stability.largest_dt(at_rest(SQUARE, [clay, gum], edge_material=split))[1:] == ("clay", "damping")
    thin = plastic("clay", 0.03)
    assert stability.largest_dt(at_rest(SQUARE, [gum, thin], edge_material=split))[1:] == ("gum", "stiffness")


def test_the_phase_with_the_most_free_nodes_counts():
    pressed, free = phase(SQUARE, 1, bottom(SQUARE) | top(SQUARE)), phase(SQUARE, 1, bottom(SQUARE))
    clay = plastic("clay", 3.0)
    light = np.where(top(SQUARE), 1e-5, 1e-2)  # only the nodes held while pressed are light
    steps = [
        stability.largest_dt(scene(SQUARE, clay, 1.0, phases, light))[0]
        for phases in ([pressed], [free], [pressed, free], [free, pressed])
    ]
    assert steps[0] > 50 * steps[1]
    assert steps[1] == steps[2] == steps[3]


@pytest.mark.parametrize("grid", [line(), SQUARE])
def test_nothing_limits_an_object_that_cannot_move(grid):
    held = phase(grid, 1, np.full(len(grid.points), True))
    problem = scene(grid, plastic("clay", 3.0), 1e9, [held])
    assert stability.largest_dt(problem)[0] == inf
    stability.check(problem)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("2-D ratio faster than the nodes", "stiffness of the material 'maxwell'"),
        ("2-D rheological", "damping of the material 'dough'"),
    ],
)
def test_a_larger_step_is_refused_with_one_that_would_do(name, reason):
    problem = CASES[name]
    bound, _, _ = stability.largest_dt(problem)
    stability.check(replace(problem, dt=bound))
    with pytest.raises(InputError) as error:
        stability.check(replace(problem, dt=0.5))
    message = r"dt must be at most (\S+) s to be stable, not 0.5: the (.*) on these masses limits it"
    told = re.fullmatch(message, str(error.value))
    assert told and told[2] == reason
    assert 0.9 * bound < float(told[1]) <= bound
    stability.check(replace(problem, dt=float(told[1])))


def test_a_damper_without_a_spring_and_a_rigid_one_are_possible():
    material = Material("m", 0.0, C1, Linear(inf), 0.0, 1.0, 0.5)
    problem = scene(line(), material, 1.0, [phase(line(), 1, [0])], MASS)
    assert stability.largest_dt(problem) == (pytest.approx(MARGIN * MASS / C1, rel=1e-9), "m", "damping")
