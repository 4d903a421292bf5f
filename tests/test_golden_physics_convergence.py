"""Order of convergence, and agreement with SciPy's solvers on an irregular mesh.

The reference right-hand side is written here from the printed equations (1) to (3) and (7); it shares nothing
with golden.physics.model.
"""

from dataclasses import replace

import numpy as np
import pytest
from golden_objects import phase, scene
from scipy.integrate import solve_ivp
from scipy.spatial import Delaunay

from golden.mesh import mesh
from golden.physics.materials import rheological, rheological_force
from golden.physics.model import Model

DIM = 2


def irregular(rng, points=14) -> mesh.Mesh:
    """Return Delaunay triangles of a grid's points, moved at random but never close to each other."""
    grid = np.stack(np.meshgrid(np.arange(4), np.arange(points // 4 + 1)), axis=-1).reshape(-1, 2)[:points]
    scattered = grid + rng.uniform(-0.3, 0.3, grid.shape)
    return mesh.from_cells(scattered / 4, Delaunay(scattered).simplices)


def thrown(rng, materials):
    """Return an irregular object of random masses and materials, two nodes fixed, and random velocities."""
    grid, fixed = irregular(rng), [0, 1]
    mass = rng.uniform(0.1, 0.3, len(grid.points))
    material = rng.integers(len(materials), size=len(grid.edges))
    velocity = 0.3 * rng.normal(size=grid.points.shape)
    velocity[fixed] = 0
    phases = [phase(grid, 1, fixed)]
    return scene(grid, materials, 1.0, phases, mass, gravity=(0.0, -1.0), edge_material=material), velocity


def run(problem, velocity, time, steps):
    model = Model(replace(problem, dt=time / steps))
    model.v = velocity.copy()
    for _ in range(steps):
        model.step()
    return np.concatenate([model.x.ravel(), model.v.ravel(), model.a])


def c2_of_7(problem, voigt, ldot, c1):
    """Return c2 of each edge: (7) at the force f for which (1) and (2) agree, by bisection of |f|."""
    c_max, c_min = problem.per_edge(lambda m: m.damper.c_max), problem.per_edge(lambda m: m.damper.c_min)
    f1, f2 = problem.per_edge(lambda m: m.damper.f1), problem.per_edge(lambda m: m.damper.f2)

    def c2(f):
        return c_max * (c_min / c_max) ** ((np.clip(f, f1, f2) - f1) / (f2 - f1))

    trial = np.abs(voigt + c1 * ldot)
    low, high = np.zeros_like(trial), trial
    for _ in range(60):
        middle = (low + high) / 2
        below = middle * (1 + c1 / c2(middle)) < trial
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return c2((low + high) / 2)


def reference(problem, velocity, time, method, linear=True, **tolerances):
    """Return the state at ``time`` by a solver of SciPy."""
    points, edges, n = problem.mesh.points, problem.mesh.edges, len(problem.mesh.points)
    k, c1, a0 = map(problem.per_edge, (lambda m: m.k, lambda m: m.c1, lambda m: m.a0))
    natural = a0 * np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
    free = ~problem.phases[0].fixed

    def rates(_, y):
        x, v, a = y[: DIM * n].reshape(n, DIM), y[DIM * n : 2 * DIM * n].reshape(n, DIM), y[2 * DIM * n :]
        total = problem.mass[:, None] * problem.gravity
        apart = x[edges[:, 1]] - x[edges[:, 0]]
        length = np.sqrt((apart**2).sum(axis=1))
        ldot = ((v[edges[:, 1]] - v[edges[:, 0]]) * apart).sum(axis=1) / length
        voigt = k * (a * length - natural)
        c2 = problem.per_edge(lambda m: m.damper.c_max) if linear else c2_of_7(problem, voigt, ldot, c1)
        a_rate = (-voigt - (c1 * a - c2 * (1 - a)) * ldot) / ((c1 + c2) * length)  # (3)
        f = -voigt - c1 * (a_rate * length + a * ldot)  # (1)
        for e, (i, j) in enumerate(edges):
            pull = f[e] * apart[e] / length[e]
            total[i] -= pull
            total[j] += pull
        acceleration = np.where(free[:, None], total / problem.mass[:, None], 0)
        return np.concatenate([v.ravel(), acceleration.ravel(), a_rate])

    y0 = np.concatenate([points.ravel(), velocity.ravel(), a0])
    solution = solve_ivp(rates, (0, time), y0, method, t_eval=[time], **tolerances)
    assert solution.success
    return solution.y[:, -1]


LINEAR = [rheological("soft", 20.0, 0.3, 0.5), rheological("firm", 40.0, 0.1, 2.0, a0=0.7)]


def test_runge_kutta_converges_with_order_four(rng):
    time = 0.2
    problem, velocity = thrown(rng, LINEAR)
    exact = reference(problem, velocity, time, "DOP853", rtol=1e-13, atol=1e-15)
    assert (exact[-len(problem.mesh.edges) :] < 0.95).all()  # smooth: no ratio was near its clamp
    errors = np.array([np.linalg.norm(run(problem, velocity, time, n) - exact) for n in (96, 192, 384)])
    orders = np.log2(errors[:-1] / errors[1:])
    print("errors", errors, "orders", orders)
    assert errors[-1] > 1e-12  # above the rounding of both
    np.testing.assert_allclose(orders, 4.0, atol=0.1)


@pytest.mark.parametrize(("method", "tolerance"), [("DOP853", 1e-12), ("Radau", 1e-10)])
def test_irregular_object_agrees_with_scipy(rng, method, tolerance):
    time, steps = 0.25, 500
    problem, velocity = thrown(rng, LINEAR)
    exact = reference(problem, velocity, time, method, rtol=tolerance, atol=tolerance / 10)
    ours, coarse = run(problem, velocity, time, steps), run(problem, velocity, time, steps // 2)
    # Richardson: the error of the fine run is a fifteenth of the difference; SciPy's is its tolerance a step
    allowed = 2 * abs(ours - coarse).max() / 15 + 100 * tolerance
    moved = exact[: problem.mesh.points.size] - problem.mesh.points.ravel()
    assert abs(moved).max() > 0.02
    assert allowed < 1e-7
    assert abs(ours - exact).max() < allowed


def test_force_dependent_dampers_agree_with_scipy(rng):
    """The law has kinks at f1 and f2, where the order is lower: a step of 2.5e-4 s across one leaves dt^2."""
    materials = [
        rheological_force("loaf", 20.0, 0.3, f1=0.02, f2=0.2, c_max=3.0, c_min=0.3),
        rheological_force("dough", 30.0, 1.0, f1=0.05, f2=0.1, c_max=1.0, c_min=0.2),
    ]
    time, steps = 0.1, 400
    problem, velocity = thrown(rng, materials)
    exact = reference(problem, velocity, time, "DOP853", linear=False, rtol=1e-9, atol=1e-11)
    assert abs(run(problem, velocity, time, steps) - exact).max() < 1e-6
    other_law = reference(problem, velocity, time, "DOP853", linear=True, rtol=1e-9, atol=1e-11)
    assert abs(other_law - exact).max() > 1e-3
