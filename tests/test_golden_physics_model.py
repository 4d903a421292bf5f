"""Phases, constraints, loads, frames and progress of the float64 model."""

import numpy as np
import pytest
from golden_objects import bottom, line, phase, press_hold_release, scene, top

from golden.mesh import mesh
from golden.physics.materials import rheological, viscoelastic
from golden.physics.model import Model, simulate
from golden.support.errors import InputError

GUM = viscoelastic("gum", 50.0, 1.0)
GRID = mesh.rectangle((3, 3), (1.0, 1.0))
DT = 1e-3


def test_fixed_nodes_stay_and_driven_nodes_move_as_prescribed():
    run = simulate(scene(GRID, GUM, DT, [phase(GRID, 100, bottom(GRID), (top(GRID), (0.3, -0.5)))], every=10))
    assert (run.x[:, bottom(GRID)] == GRID.points[bottom(GRID)]).all()
    assert (run.v[:, bottom(GRID)] == 0).all() and (run.v[:, top(GRID)] == [0.3, -0.5]).all()
    expected = GRID.points[top(GRID)] + run.t[:, None, None] * [0.3, -0.5]
    np.testing.assert_allclose(run.x[:, top(GRID)], expected, atol=100 * np.finfo(float).eps)


def test_a_released_node_keeps_its_velocity_and_a_fixed_one_loses_it():
    weak = viscoelastic("weak", 1e-9, 0.0)
    phases = [phase(line(), 10, [0], ([1], (2.0, 0.0))), phase(line(), 10, [0]), phase(line(), 10, [0, 1])]
    run = simulate(scene(line(), weak, DT, phases, every=5))
    assert run.v[:, 1, 0] == pytest.approx([2, 2, 2, 2, 2, 0, 0], abs=1e-9)
    assert run.x[:, 1, 0] == pytest.approx([1, 1.01, 1.02, 1.03, 1.04, 1.04, 1.04], abs=1e-9)


def test_a_frame_at_the_end_of_a_phase_shows_that_phase():
    phases = [phase(line(), 10, [0], ([1], (2.0, 0.0))), phase(line(), 10, [0, 1])]
    run = simulate(scene(line(), GUM, DT, phases))
    assert np.array_equal(run.t, [0, 10 * DT, 20 * DT])
    assert run.v[:, 1, 0].tolist() == [2.0, 2.0, 0.0]
    damping, spring = 1.0 * 2.0, 50.0 * 0.02
    np.testing.assert_allclose(run.reaction[:, 1, 0], [damping, damping + spring, spring], rtol=1e-12)
    np.testing.assert_allclose(run.reaction[:, 0], -run.reaction[:, 1], rtol=1e-12)


def test_frames_are_those_asked_for():
    phases = press_hold_release(GRID, 0.1, (7, DT), 3, 5)
    run = simulate(scene(GRID, GUM, DT, phases, every=4))
    np.testing.assert_allclose(run.t, DT * np.array([0, 4, 7, 8, 10, 12, 15]), rtol=1e-15)
    n, e = len(GRID.points), len(GRID.edges)
    assert [a.shape for a in (run.x, run.v, run.a, run.reaction)] == [(7, n, 2), (7, n, 2), (7, e), (7, n, 2)]
    assert run.edges is GRID.edges
    assert np.array_equal(run.x[0], GRID.points)


def test_gravity_and_loads_accelerate_a_free_object():
    """A uniform force per mass deforms nothing: x = x0 + g t^2 / 2, which Runge-Kutta integrates exactly."""
    mass = np.linspace(0.1, 0.5, 9)
    pull = np.outer(mass, (0.0, 4.0))  # the same as gravity
    run = simulate(scene(GRID, GUM, DT, [phase(GRID, 200, load=(range(9), pull))], mass, gravity=(1.0, -3.0)))
    np.testing.assert_allclose(run.x[-1] - GRID.points, np.full((9, 2), 0.02), rtol=1e-10)
    np.testing.assert_allclose(run.v[-1], np.full((9, 2), 0.2), rtol=1e-10)
    assert (run.reaction == 0).all()


def test_a_load_lasts_for_its_phase_and_a_support_carries_it():
    push = (0.0, -2.0)
    phases = [phase(GRID, 3000, bottom(GRID), load=(top(GRID), push)), phase(GRID, 3000, bottom(GRID))]
    run = simulate(scene(GRID, GUM, DT, phases, mass=0.05))
    np.testing.assert_allclose(run.reaction[1].sum(axis=0), [0, 6.0], atol=1e-4)  # all but at rest
    assert (run.x[1, top(GRID), 1] < 0.98).all()
    assert abs(run.x[2] - run.x[0]).max() < 1e-4


def test_the_reaction_counts_the_load_and_the_weight_of_the_held_node_itself():
    phases = [phase(line(), 1, [0, 1], load=([1], (3.0, 1.0)))]
    run = simulate(scene(line(), GUM, DT, phases, mass=2.0, gravity=(0.0, -10.0)))
    np.testing.assert_allclose(run.reaction[-1], [[0, 20], [-3, 19]], rtol=1e-15)


def test_the_model_can_be_stepped_by_hand():
    problem = scene(GRID, GUM, DT, [phase(GRID, 5, bottom(GRID), (top(GRID), (0.0, -1.0)))])
    model = Model(problem)
    for _ in range(5):
        model.step()
    run = simulate(problem)
    assert np.array_equal(model.x, run.x[-1]) and np.array_equal(model.v, run.v[-1])
    assert np.array_equal(model.reaction(), run.reaction[-1])
    assert np.array_equal(problem.mesh.points, GRID.points) and (problem.mesh.points[:, 1] <= 1).all()


def test_materials_belong_to_edges():
    """A chain of a soft and a stiff edge between two held ends: the soft one takes the deformation."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]])
    chain = mesh.Mesh(points, np.empty((0, 3), int), np.array([[0, 1], [1, 2]]))
    materials = [viscoelastic("soft", 10.0, 1.0), viscoelastic("stiff", 90.0, 9.0)]
    phases = [phase(chain, 100, [0], ([2], (-1.0, 0.0))), phase(chain, 3000, [0, 2])]
    run = simulate(scene(chain, materials, DT, phases, mass=0.1, edge_material=[0, 1]))
    # springs in series share 0.1 m like 1 / k
    np.testing.assert_allclose(run.x[-1, 1, 0], 1 - 0.09, rtol=1e-9)


def test_progress_is_reported_every_so_often():
    told = []
    simulate(scene(line(), GUM, DT, [phase(line(), 450, [0]), phase(line(), 50, [0])]), progress=told.append)
    assert told == [200, 400, 450, 500]


def test_a_diverging_run_is_an_error():
    """Far above the largest stable step: the run must end with an error, not with NaN in the frames."""
    push = phase(GRID, 5000, bottom(GRID), load=(top(GRID), (0.0, -1.0)), name="push")
    dough = rheological("dough", 1e4, 10.0, 10.0)
    problem = scene(GRID, dough, 0.1, [phase(GRID, 100, bottom(GRID)), push])
    with pytest.raises(InputError) as error:
        simulate(problem)
    expected = "dt must be small enough for a finite state, not 0.1: lost by step 200 in phase 'push'"
    assert str(error.value) == expected
