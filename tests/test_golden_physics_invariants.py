"""Invariants of every object, whatever its material: momentum, energy, symmetry, the clamp, rest."""

from dataclasses import replace

import numpy as np
import pytest
from golden_objects import phase, scene

from golden.mesh import mesh
from golden.physics.dampers import Linear
from golden.physics.materials import Material, plastic, rheological, rheological_force, viscoelastic
from golden.physics.model import Model, simulate

EPS = np.finfo(float).eps
FORCE = rheological_force("loaf", 20.0, 0.3, f1=0.02, f2=0.2, c_max=3.0, c_min=0.3)
MIXED = [viscoelastic("gum", 30.0, 0.3), plastic("clay", 0.2), rheological("dough", 20.0, 0.3, 0.5), FORCE]
GRIDS = {"2-D": mesh.rectangle((4, 4), (1.0, 1.0)), "3-D": mesh.box((3, 3, 3), (1.0, 1.0, 1.0))}


def free_object(rng, grid, materials=MIXED, dt=1e-3, steps=300):
    """Return a free object of random masses and materials, and random velocities."""
    material = rng.integers(len(materials), size=len(grid.edges))
    mass = rng.uniform(0.1, 0.3, len(grid.points))
    problem = scene(grid, materials, dt, [phase(grid, steps)], mass, edge_material=material, every=1)
    return problem, 0.5 * rng.normal(size=grid.points.shape)


def run(problem, velocity):
    model = Model(problem)
    model.v = velocity.copy()
    for _ in range(problem.steps):
        model.step()
    return model


@pytest.mark.parametrize("dim", GRIDS)
def test_a_free_object_keeps_its_momentum(rng, dim):
    problem, velocity = free_object(rng, GRIDS[dim])
    momentum = problem.mass @ velocity
    model = run(problem, velocity)
    after = problem.mass @ model.v
    # forces cancel in pairs; per step each node rounds its momentum a few times, and its sum of forces (up to
    # 60 N, over at most 18 edges, times dt) once for each edge
    rounding = EPS * (4 * problem.mass @ abs(velocity).max(axis=1) + 18 * 60 * problem.dt * len(problem.mass))
    assert abs(after - momentum).max() < problem.steps * rounding < 1e-9
    assert abs(model.v - velocity).max() > 0.1


@pytest.mark.parametrize("dim", GRIDS)
def test_the_centre_of_a_free_object_moves_uniformly(rng, dim):
    problem, velocity = free_object(rng, GRIDS[dim])
    time = problem.steps * problem.dt
    expected = problem.mass @ (problem.mesh.points + time * velocity)
    assert problem.mass @ run(problem, velocity).x == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(
    "material",
    [
        viscoelastic("gum", 30.0, 0.3),
        plastic("clay", 0.2),
        rheological("dough", 20.0, 0.3, 0.5),
        rheological("no c1", 20.0, 0.0, 0.5),
    ],
    ids=lambda m: m.name,
)
@pytest.mark.parametrize("dim", GRIDS)
def test_energy_never_grows(rng, dim, material):
    """Return kinetic energy plus that of the springs, k (a l - L)^2 / 2, while no ratio is at its clamp."""
    problem, velocity = free_object(rng, GRIDS[dim], [material])
    model = Model(problem)
    model.v = 0.5 * velocity
    i, j = problem.mesh.edges.T
    energies = []
    for _ in range(problem.steps):
        strain = model.a * np.linalg.norm(model.x[j] - model.x[i], axis=1) - model.L
        energies.append(problem.mass @ (model.v**2).sum(axis=1) / 2 + material.k * (strain @ strain) / 2)
        assert material.name == "gum" or ((0 < model.a) & (model.a < 1)).all()
        model.step()
    growth = np.diff(energies)
    assert growth.max() <= 8 * EPS * energies[0]
    assert energies[-1] < 0.9 * energies[0]


def rotation(rng, dim):
    q, r = np.linalg.qr(rng.normal(size=(dim, dim)))
    return q * np.sign(np.diag(r))


def moved_object(problem, velocity, turn, shift):
    """Return the same object, rotated and shifted, with rotated gravity."""
    grid = problem.mesh
    grid = mesh.Mesh(grid.points @ turn.T + shift, grid.cells, grid.edges)
    return replace(problem, mesh=grid, gravity=turn @ problem.gravity), velocity @ turn.T


@pytest.mark.parametrize("dim", GRIDS)
def test_rotated_and_shifted_objects_do_the_same(rng, dim):
    problem, velocity = free_object(rng, GRIDS[dim])
    problem = replace(problem, gravity=rng.normal(size=problem.dim))
    turn, shift = rotation(rng, problem.dim), 3 * rng.normal(size=problem.dim)
    original, turned = run(problem, velocity), run(*moved_object(problem, velocity, turn, shift))
    # positions of size 10 round by 2 EPS a step, and that returns as a force on a neighbour at most once
    tolerance = problem.steps * 20 * EPS * 10
    np.testing.assert_allclose(turned.x, original.x @ turn.T + shift, atol=tolerance)
    np.testing.assert_allclose(turned.v, original.v @ turn.T, atol=10 * tolerance)
    np.testing.assert_allclose(turned.a, original.a, atol=tolerance)


@pytest.mark.parametrize("dim", GRIDS)
def test_renumbered_objects_do_the_same(rng, dim):
    problem, velocity = free_object(rng, GRIDS[dim])
    order = rng.permutation(len(velocity))  # order[new] = old
    new = np.argsort(order)
    ends = np.sort(new[problem.mesh.edges], axis=1)
    edge_order = np.lexsort(ends.T[::-1])
    grid = mesh.Mesh(problem.mesh.points[order], new[problem.mesh.cells], ends[edge_order])
    renumbered = replace(
        problem,
        mesh=grid,
        mass=problem.mass[order],
        phases=(phase(grid, problem.steps),),
        edge_material=problem.edge_material[edge_order],
    )
    original, other = run(problem, velocity), run(renumbered, velocity[order])
    tolerance = problem.steps * 20 * EPS
    np.testing.assert_allclose(other.x, original.x[order], atol=tolerance)
    np.testing.assert_allclose(other.a, original.a[edge_order], atol=tolerance)


class Watched(Model):
    """A model that records the ratios of every Runge-Kutta stage."""

    def __init__(self, problem):
        super().__init__(problem)
        self.seen = []

    def rates(self, x, v, a):
        self.seen.append(a.copy())
        return super().rates(x, v, a)


@pytest.mark.parametrize("dim", GRIDS)
def test_ratios_stay_within_their_bounds_in_every_stage(rng, dim):
    loose = Material("loose", 20.0, 0.3, Linear(0.5), 0.0, 1.0, 0.5)
    tight = replace(loose, name="tight", a_min=0.48, a_max=0.53)
    materials = [loose, tight, replace(FORCE, a_min=0.49, a_max=0.5)]
    problem, velocity = free_object(rng, GRIDS[dim], materials, steps=100)
    low, high = problem.per_edge(lambda m: m.a_min), problem.per_edge(lambda m: m.a_max)
    model = Watched(problem)
    model.v = 3 * velocity
    for _ in range(problem.steps):
        model.step()
        model.seen.append(model.a.copy())
    seen = np.array(model.seen).reshape(problem.steps, 5, -1)  # four stages and the final value
    assert (seen >= low).all() and (seen <= high).all()
    for part in range(1, 5):  # each was stopped at both ends (the first stage is the last step's final value)
        assert (seen[:, part] == low).any() and (seen[:, part] == high).any()


@pytest.mark.parametrize("dim", GRIDS)
def test_an_object_at_rest_stays_exactly_at_rest(rng, dim):
    problem, _ = free_object(rng, GRIDS[dim])
    trajectory = simulate(problem)
    assert (trajectory.x == problem.mesh.points).all()
    assert (trajectory.v == 0).all() and (trajectory.a == problem.per_edge(lambda m: m.a0)).all()
