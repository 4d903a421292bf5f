"""Damper laws: equation (7), rho and sigma, and how a law is restored from its parameters."""

from dataclasses import asdict
from math import inf

import numpy as np
import pytest

from golden.physics import dampers
from golden.physics.dampers import Exponential, Linear, series
from golden.support.errors import InputError

EPS = np.finfo(float).eps


@pytest.mark.parametrize(("f1", "f2"), [(0.0, 1.0), (0.5, 2.0), (100.0, 100.001)])
def test_the_exponential_law_is_equation_7(f1, f2):
    c_max, c_min = 1e6, 1e-3  # at the last pair exp(B f1) is beyond every float
    c2 = Exponential(f1, f2, c_max, c_min).c2
    b = np.log(c_max / c_min) / (f2 - f1)
    ends = np.array([f1, f2])
    # a step of one unit in the last place of f changes c2 by that times B; 8 for the roundings on the way
    tolerance = 8 * EPS * (1 + b * f2)
    for side in (-inf, inf):  # continuous from both sides
        np.testing.assert_allclose(c2(np.nextafter(ends, side)), [c_max, c_min], rtol=tolerance)
    assert c2(f1) == c_max and c2(f2) == c_min
    assert (c2([0.0, f1 / 2, -f1]) == c_max).all()
    assert (c2([f2, -10 * f2, inf]) == c_min).all()
    middle = np.linspace(f1, f2, 101)
    np.testing.assert_allclose(c2(middle[1:]) / c2(middle[:-1]), np.exp(-b * np.diff(middle)), rtol=tolerance)
    assert np.array_equal(c2(-middle), c2(middle))


def test_a_linear_law_is_one_coefficient():
    assert np.array_equal(Linear(2.0).c2([0.0, -0.5, 3.0]), [2.0, 2.0, 2.0])


def bisection(c1, damper, size):
    """Return |f| with |f| (1 + c1 / c2(|f|)) = |g|: halve an interval until no float lies inside."""
    low, high = 0.0, size
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if middle * (1 + c1 / damper.c2(middle)) < size else (low, middle)
    return low


def random_dampers(rng, n):
    """Yield pairs (c1, damper); one in twenty has no c1, one in twenty falls from the force 0 on."""
    for _ in range(n):
        c1 = 10.0 ** rng.uniform(-3, 4) * (rng.random() > 0.05)
        c_min = 10.0 ** rng.uniform(-2, 2)
        f1 = 10.0 ** rng.uniform(-3, 1) * (rng.random() > 0.05)
        yield c1, Exponential(f1, f1 + 10.0 ** rng.uniform(-2, 1), c_min * 10.0 ** rng.uniform(0.1, 4), c_min)


def test_rho_and_sigma_against_bisection(rng):
    branches = [0, 0, 0]
    for c1, damper in random_dampers(rng, 1000):
        g1, g2 = damper.knees(c1)
        size = 10.0 ** rng.uniform(np.log10(g1 + 1e-4) - 1, np.log10(g2) + 1)
        rho, sigma = damper.rho_sigma(c1, size * rng.choice([-1, 1]))
        f = bisection(c1, damper, size)
        c2 = damper.c2(f)
        branches[1 if damper.f1 < f < damper.f2 else 0 if f <= damper.f1 else 2] += 1
        # the change of c2 over one unit in the last place of f, and a dozen roundings
        b = np.log(damper.c_max / damper.c_min) / (damper.f2 - damper.f1)
        tolerance = 12 * EPS * (1 + b * damper.f2)
        assert rho == pytest.approx(c2 / (c1 + c2), rel=tolerance)
        assert sigma == pytest.approx(1 / (c1 + c2), rel=tolerance)
        assert rho * size == pytest.approx(f, rel=tolerance)
    assert min(branches) > 100, branches


def test_outside_the_knees_rho_and_sigma_are_the_constants_exactly(rng):
    for c1, damper in random_dampers(rng, 200):
        g1, g2 = damper.knees(c1)
        for g, c2 in ((0.0, damper.c_max), (-g1 / 2, damper.c_max), (g1, damper.c_max)):
            assert damper.rho_sigma(c1, g) == series(c1, c2)
        for g in (g2, -3 * g2, inf):
            assert damper.rho_sigma(c1, g) == series(c1, damper.c_min)


def test_the_middle_branch_goes_on_smoothly_past_both_knees(rng):
    """The formula holds instead of the constants, from f1 / 2 to where c2 is 1e-12 of c_min."""
    tried = 0
    for c1, damper in random_dampers(rng, 200):
        b = np.log(damper.c_max / damper.c_min) / (damper.f2 - damper.f1)
        f = np.linspace(damper.f1 / 2 + 1e-6, damper.f2 + 27 / b, 50)
        with np.errstate(over="ignore"):
            c2 = damper.c_max * np.exp(-b * (f - damper.f1))
        size = f * (1 + c1 / c2)
        rho, sigma = damper.middle_rho_sigma(c1, size)
        tolerance = 12 * EPS * (1 + b * f.max())
        np.testing.assert_allclose(rho * size, f, rtol=tolerance)
        np.testing.assert_allclose(sigma, 1 / (c1 + c2), rtol=tolerance)
        tried += (f < damper.f1).any() and (f > damper.f2).any()
    assert tried > 150


def test_far_past_its_knees_a_branch_has_a_root_all_the_same():
    """A table may reach to thousands of times g2, where Newton's method alone would overflow."""
    damper, c1 = Exponential(0.05, 0.06, 1e4, 1.0), 1e-4
    size = 0.06 * np.geomspace(1, 1e4, 200)
    rho, _ = damper.middle_rho_sigma(c1, size)
    f = rho * size
    c2 = 1e4 * np.exp(-np.log(1e4) / 0.01 * (f - 0.05))
    np.testing.assert_allclose(f * (1 + c1 / c2), size, rtol=1e-9)


def test_a_branch_without_c1_stays_within_floats_however_far_it_goes():
    rho, sigma = Exponential(1e-5, 0.9, 1.5, 1.0).middle_rho_sigma(0.0, np.geomspace(1e-5, 1e5, 50))
    assert np.array_equal(rho, np.ones(50)) and np.isfinite(sigma).all() and (np.diff(sigma) >= 0).all()


def test_force_rises_with_the_trial_force_and_never_jumps():
    c1, damper = 50.0, Exponential(f1=0.5, f2=2.0, c_max=100.0, c_min=1.0)
    g = np.linspace(0, 200, 20001)
    steps = np.diff(damper.rho_sigma(c1, g)[0] * g) / np.diff(g)
    assert (steps > 0).all()
    assert steps.max() <= 1 / (1 + c1 / damper.c_max) * (1 + 1e-9)  # the stiffest branch, and rounding


def test_a_rigid_damper_leaves_the_trial_force():
    rho, sigma = Linear(inf).rho_sigma(3.0, [0.0, -1.0, 1e9])
    assert np.array_equal(sigma, np.zeros(3)) and np.array_equal(rho, np.ones(3))


def test_without_c1_the_damper_carries_the_trial_force():
    damper, g = Exponential(f1=0.5, f2=2.0, c_max=100.0, c_min=1.0), np.array([0.1, 1.0, 1.9, 5.0])
    rho, sigma = damper.rho_sigma(0.0, g)
    assert np.array_equal(rho, np.ones(4))
    np.testing.assert_allclose(1 / sigma, damper.c2(g), rtol=1e-14)


def test_trial_forces_may_have_any_shape():
    damper, g = Exponential(f1=0.5, f2=2.0, c_max=8, c_min=1), np.array([[0.1, 1.5], [3.0, -90.0]])
    rho, sigma = damper.rho_sigma(1.0, g)
    assert sigma.shape == rho.shape == (2, 2)
    for place in np.ndindex(2, 2):
        assert (rho[place], sigma[place]) == damper.rho_sigma(1.0, g[place])


@pytest.mark.parametrize("ratio", [1e2, 1e4, 1e6])
def test_with_large_c1_the_two_dampers_are_c2_alone(ratio):
    """Equation (8): c1 c2 / (c1 + c2) differs from c2 by the part c2 / (c1 + c2)."""
    c2 = 3.0
    rho, _ = Linear(c2).rho_sigma(ratio * c2, 1.0)
    assert rho * ratio * c2 == pytest.approx(c2, rel=1.0 / ratio)
    assert rho * ratio * c2 != pytest.approx(c2, rel=0.5 / ratio)


@pytest.mark.parametrize("damper", [Linear(inf), Linear(2.5), Exponential(0.1, 1 / 3, 1e3, 0.7)])
def test_a_damper_is_restored_from_its_parameters(damper):
    assert dampers.restore(type(damper).__name__, asdict(damper)) == damper


def test_an_unknown_law_is_refused():
    with pytest.raises(InputError, match=r"^law must be one of Linear, Exponential.*, not 'Quadratic'$"):
        dampers.restore("Quadratic", {"c": 1.0})
