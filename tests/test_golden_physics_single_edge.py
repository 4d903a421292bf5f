"""One edge: the printed equations, and the closed forms of press, hold and release."""

import math

import numpy as np
import pytest
from golden_objects import line, phase, scene

from golden.physics.dampers import Linear
from golden.physics.materials import Material, plastic, plastic_force, rheological, rheological_force, viscoelastic
from golden.physics.model import Model, simulate

FORCE = dict(f1=0.5, f2=2.0, c_max=30.0, c_min=1.0)
L0, DEPTH = 1.0, 0.2


@pytest.mark.parametrize(
    "material",
    [
        rheological("linear", 100.0, 2.0, 3.0),
        rheological("no c1", 100.0, 0.0, 3.0),
        plastic("plastic", 2.0),
        rheological_force("force", 100.0, 2.0, **FORCE),
        plastic_force("plastic force", 300.0, **FORCE),
    ],
    ids=lambda m: m.name,
)
def test_force_and_ratio_satisfy_the_printed_equations(material, rng):
    model = Model(scene(line(), material, 1e-3, [phase(line(), 1)]))
    k, c1 = material.k, material.c1
    for _ in range(200):
        length, a = rng.uniform(0.5, 1.5), rng.uniform(0.1, 0.9)
        ldot = rng.normal() * 10.0 ** rng.uniform(-3, 1)
        force, a_rate = (value[0] for value in model.edge_law(np.array([length]), ldot, np.array([a])))
        c2 = material.damper.c2(force)
        voigt = k * (a * length - model.L[0])
        scale = abs(voigt) + (c1 + c2) * abs(ldot)  # of the terms that cancel in the equations
        # c2 at a force within one unit in the last place: 1 + B f2 < 8; and a dozen roundings
        tolerance = 12 * 8 * np.finfo(float).eps * scale
        assert force == pytest.approx(-voigt - c1 * (a_rate * length + a * ldot), abs=tolerance)  # (1)
        assert force == pytest.approx(-c2 * (-a_rate * length + (1 - a) * ldot), abs=tolerance)  # (2)
        printed = (-voigt - (c1 * a - c2 * (1 - a)) * ldot) / ((c1 + c2) * length)  # (3)
        assert a_rate == pytest.approx(printed, abs=tolerance / ((c1 + c2) * length))


def press(material, press_time, hold_time, dt, release_time=0.0, mass=0.02):
    """Return the trajectory of an edge whose far end is pressed by DEPTH in ``press_time``, held, and let go."""
    edge = line(L0)
    steps = [round(time / dt) for time in (press_time, hold_time, release_time)]
    phases = [phase(edge, steps[0], [0], ([1], (-DEPTH / press_time, 0.0))), phase(edge, steps[1], [0, 1])]
    if steps[2]:
        phases.append(phase(edge, steps[2], [0]))
    return simulate(scene(edge, material, dt, phases, mass=mass))


def voigt_strain(material, press_time, hold_time):
    """Return -(a l - L) after pressing at constant speed and holding: the solution of dq/dt = rho ldot - q / tau."""
    c = material.damper.c_max
    q, tau = c / (material.c1 + c), (material.c1 + c) / material.k
    pressed = DEPTH * q * tau / press_time * (1 - math.exp(-press_time / tau))
    return pressed * math.exp(-hold_time / tau)


RHEOLOGICAL = rheological("gel", k=20.0, c1=2.0, c2=3.0)  # q = 0.6, tau = 0.25 s


@pytest.mark.parametrize("hold_time", [0.1, 0.25, 1.0])
def test_voigt_part_follows_the_closed_form_while_pressed_and_held(hold_time):
    run = press(RHEOLOGICAL, 0.05, hold_time, dt=1e-3)
    strain = RHEOLOGICAL.a0 * L0 - run.a[-1, 0] * (run.x[-1, 1, 0] - run.x[-1, 0, 0])
    # the local error of Runge-Kutta in a step, (dt / tau)^5 / 120 of the strain, times the steps
    tolerance = DEPTH * (1e-3 / 0.25) ** 4 / 120 * (0.05 + hold_time) / 0.25
    assert strain == pytest.approx(voigt_strain(RHEOLOGICAL, 0.05, hold_time), abs=tolerance)


@pytest.mark.parametrize("hold_time", [0.1, 0.25, 1.0])
def test_bounce_back_of_a_rheological_edge(hold_time):
    """Let go at rest, the edge comes back by exactly its Voigt part's strain, whatever the mass.

    m dv/dt = f over the release gives the integral of the strain as -c1 / k times the bounce-back, and with
    it dq/dt gives the bounce-back as minus the strain. Pressed in no time that is D q exp(-T / tau); pressing
    in t changes it by (t / tau)^2 / 24 when T is counted from the middle of the press.
    """
    q, tau, press_time, dt = 0.6, 0.25, 0.05, 2e-3
    for mass in (0.02, 0.1):
        run = press(RHEOLOGICAL, press_time, hold_time, dt, release_time=4.0, mass=mass)
        released, final = run.x[-2, 1, 0], run.x[-1, 1, 0]
        assert released == pytest.approx(L0 - DEPTH, abs=1e-12)
        assert abs(run.v[-1]).max() < 1e-9  # it has come to rest
        # Runge-Kutta at a fastest rate of rho c1 / m = 60 per s: (60 dt)^4 / 120 of the strain
        tolerance = DEPTH * (60 * dt) ** 4 / 120
        strain = voigt_strain(RHEOLOGICAL, press_time, hold_time)
        assert final - released == pytest.approx(strain, abs=tolerance)
        in_no_time = DEPTH * q * math.exp(-(hold_time + press_time / 2) / tau)
        assert final - released == pytest.approx(in_no_time, rel=1.1 * (press_time / tau) ** 2 / 24)


def test_a_viscoelastic_edge_returns_fully():
    run = press(viscoelastic("gum", k=20.0, c1=2.0), 0.05, 0.5, 2e-3, release_time=4.0)
    # the slowest mode of 0.02 x'' + 2 x' + 20 x decays at 11.3 per s: exp(-45) is left, rounding is more
    assert abs(run.x[-1] - run.x[0]).max() < 1e-12
    assert (run.a == 1).all()


def test_a_plastic_edge_does_not_bounce_back():
    run = press(plastic("clay", 2.0), 0.05, 0.2, 5e-4, release_time=2.0)
    assert abs(run.x[-1] - run.x[-2]).max() == 0.0  # f = -c ldot is exactly 0 at rest
    assert run.x[-1, 1, 0] == pytest.approx(L0 - DEPTH, abs=1e-12)
    assert run.a == pytest.approx(0.5, abs=1e-12)


def test_pressing_a_plastic_edge_takes_its_damper_times_the_speed():
    run = press(plastic("clay", 2.0), 0.05, 0.2, 5e-4)
    force = 2.0 * DEPTH / 0.05  # equation (6): c1 c2 / (c1 + c2) = 2 N s/m
    np.testing.assert_allclose(run.reaction[1], [[force, 0], [-force, 0]], rtol=1e-12, atol=1e-12)


def test_a_held_rheological_edge_forgets_its_force():
    """f = -rho k q and q decays with tau = (c1 + c2) / k: the support's force falls like exp(-t / tau)."""
    forces = [press(RHEOLOGICAL, 0.05, hold, dt=1e-3).reaction[-1, 0, 0] for hold in (0.1, 0.35, 0.6)]
    assert forces[0] > 0
    tolerance = 2 * (1e-3 / 0.25) ** 4 / 120  # Runge-Kutta's error in a time of tau
    np.testing.assert_allclose(np.divide(forces[1:], forces[:-1]), math.exp(-1), rtol=tolerance)


@pytest.mark.parametrize("end", [0.7, 1.6])
def test_permanent_deformation_is_bounded_by_the_clamp(end):
    """The relaxed length stays within [L / a_max, L / a_min]; without clamp it stays where it was put."""
    edge, dt = line(L0), 2e-3
    speed = (end - L0) / (100 * dt)
    phases = [phase(edge, 100, [0], ([1], (speed, 0.0))), phase(edge, 500, [0, 1]), phase(edge, 2000, [0])]
    relaxed = {}
    for a_min, a_max in ((0.0, 1.0), (0.45, 0.6), (0.48, 0.52)):
        material = rheological("gel", k=200.0, c1=2.0, c2=3.0, a_min=a_min, a_max=a_max, a0=0.5)
        run = simulate(scene(edge, material, dt, phases, mass=0.02))
        assert abs(run.v[-1]).max() < 1e-9
        relaxed[a_min] = run.x[-1, 1, 0]
        assert 0.5 * L0 / a_max <= relaxed[a_min] <= 0.5 * L0 / max(a_min, 0.1)
    assert relaxed[0.0] == pytest.approx(end, abs=1e-9)  # the Voigt part is relaxed, the hold lasts 40 tau
    assert abs(relaxed[0.48] - L0) < abs(relaxed[0.45] - L0) < abs(end - L0)


def test_a_free_end_on_a_damper_stops_like_an_exponential():
    """m dv/dt = -c v with c = c1 c2 / (c1 + c2), equation (6), from two dampers in series."""
    c1, c2, mass, dt, steps = 3.0, 6.0, 0.5, 1e-3, 500
    material = Material("two", 0.0, c1, Linear(c2), 0, 1, 0.5)
    model = Model(scene(line(), material, dt, [phase(line(), steps, [0])], mass=mass))
    model.v[1, 0] = 0.3
    for _ in range(steps):
        model.step()
    rate = c1 * c2 / (c1 + c2) / mass
    # the local error of Runge-Kutta, (rate dt)^5 / 120 of the velocity, times the steps
    tolerance = steps * (rate * dt) ** 5 / 120
    assert model.v[1, 0] == pytest.approx(0.3 * math.exp(-rate * dt * steps), rel=tolerance)
