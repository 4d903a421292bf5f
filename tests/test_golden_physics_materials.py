"""The presets, equation (7) and the damper that depends on the force it carries."""

import math

import numpy as np
import pytest

from golden.physics.materials import PRESETS, Material, solve_damper
from golden.support.errors import InputError

FORCE = dict(f1=0.5, f2=2.0, c_max=100.0, c_min=1.0)
VALID = {
    "viscoelastic": dict(k=100.0, c1=1.0),
    "plastic": dict(c_damper=2.0),
    "rheological": dict(k=100.0, c1=1.0, c2=3.0),
    "rheological-force": dict(k=100.0, c1=1.0, **FORCE),
    "plastic-force": dict(c1=900.0, **FORCE),
}
inf = math.inf


@pytest.mark.parametrize(
    ("preset", "expected"),
    [
        ("viscoelastic", Material("m", 100.0, 1.0, inf, inf, inf, inf, 1.0, 1.0, 1.0)),
        ("plastic", Material("m", 0.0, 4.0, 4.0, 4.0, inf, inf, 0.0, 1.0, 0.5)),
        ("rheological", Material("m", 100.0, 1.0, 3.0, 3.0, inf, inf, 0.0, 1.0, 0.5)),
        ("rheological-force", Material("m", 100.0, 1.0, 100.0, 1.0, 0.5, 2.0, 0.0, 1.0, 0.5)),
        ("plastic-force", Material("m", 0.0, 900.0, 100.0, 1.0, 0.5, 2.0, 0.0, 1.0, 0.1)),
    ],
)
def test_presets_give_the_table_of_the_design(preset, expected):
    material = PRESETS[preset]("m", **VALID[preset])
    assert material == expected
    assert material.linear == (not preset.endswith("force"))


def test_a_damper_with_equal_coefficients_is_linear():
    material = PRESETS["plastic-force"]("m", c1=9.0, f1=0.0, f2=1.0, c_max=2.0, c_min=2.0)
    assert material.linear
    assert np.array_equal(material.c2([0.0, 0.5, 3.0]), [2.0, 2.0, 2.0])


@pytest.mark.parametrize(("f1", "f2"), [(0.0, 1.0), (0.5, 2.0), (100.0, 100.001)])
def test_damper_law_is_equation_7(f1, f2):
    c_max, c_min = 1e6, 1e-3  # at the last pair exp(B f1) is beyond every float
    material = Material("m", 0, 1, c_max, c_min, f1, f2, 0, 1, 1)
    b = np.log(c_max / c_min) / (f2 - f1)
    ends = np.array([f1, f2])
    # a step of one unit in the last place of f changes c2 by that times B; 8 for the roundings on the way
    tolerance = 8 * np.finfo(float).eps * (1 + b * f2)
    for side in (-inf, inf):  # continuous from both sides
        np.testing.assert_allclose(material.c2(np.nextafter(ends, side)), [c_max, c_min], rtol=tolerance)
    assert material.c2(f1) == c_max and material.c2(f2) == c_min
    assert (material.c2([0.0, f1 / 2, -f1]) == c_max).all()
    assert (material.c2([f2, -10 * f2, inf]) == c_min).all()
    middle = np.linspace(f1, f2, 101)
    ratio = material.c2(middle[1:]) / material.c2(middle[:-1])
    np.testing.assert_allclose(ratio, np.exp(-b * np.diff(middle)), rtol=tolerance)
    assert np.array_equal(material.c2(-middle), material.c2(middle))


def bisection(c1, material, size):
    """|f| with |f| (1 + c1 / c2(|f|)) = |g|: halves an interval until nothing lies between its ends."""
    low, high = 0.0, size
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if middle * (1 + c1 / material.c2(middle)) < size else (low, middle)
    return low


def random_dampers(rng, n):
    c1 = 10.0 ** rng.uniform(-3, 4, n) * (rng.random(n) > 0.05)  # one in twenty without c1
    c_min = 10.0 ** rng.uniform(-2, 2, n)
    c_max = c_min * 10.0 ** rng.uniform(0.1, 4, n)
    f1 = 10.0 ** rng.uniform(-3, 1, n) * (rng.random(n) > 0.05)  # one in twenty from force 0 on
    f2 = f1 + 10.0 ** rng.uniform(-2, 1, n)
    return c1, c_max, c_min, f1, f2


def test_force_dependent_damper_against_bisection(rng):
    c1, c_max, c_min, f1, f2 = parameters = random_dampers(rng, 1000)
    g1, g2 = f1 * (1 + c1 / c_max), f2 * (1 + c1 / c_min)
    size = 10.0 ** rng.uniform(np.log10(g1 + 1e-4) - 1, np.log10(g2) + 1)
    g = size * rng.choice([-1, 1], size.shape)
    sigma, rho = solve_damper(*parameters, g)
    branches = [0, 0, 0]
    for n in range(len(g)):
        material = Material("m", 0, *(p[n] for p in parameters), 0, 1, 1)
        f = bisection(c1[n], material, size[n])
        c2 = material.c2(f)
        branches[1 if f1[n] < f < f2[n] else 0 if f <= f1[n] else 2] += 1
        # what one unit in the last place of f does to c2, and a dozen roundings
        tolerance = 12 * np.finfo(float).eps * (1 + np.log(c_max[n] / c_min[n]) / (f2[n] - f1[n]) * f2[n])
        assert rho[n] == pytest.approx(c2 / (c1[n] + c2), rel=tolerance)
        assert sigma[n] == pytest.approx(1 / (c1[n] + c2), rel=tolerance)
        assert rho[n] * size[n] == pytest.approx(f, rel=tolerance)
    assert min(branches) > 100, branches


def test_outer_branches_are_the_constants_exactly(rng):
    c1, c_max, c_min, f1, f2 = parameters = random_dampers(rng, 200)
    g1, g2 = f1 * (1 + c1 / c_max), f2 * (1 + c1 / c_min)
    for g, c2 in ((0 * g1, c_max), (-g1 / 2, c_max), (g1, c_max), (g2, c_min), (-3 * g2, c_min)):
        sigma, rho = solve_damper(*parameters, g)
        assert np.array_equal(sigma, 1 / (c1 + c2)) and np.array_equal(rho, 1 / (1 + c1 / c2))


def test_force_rises_with_the_trial_force_and_never_jumps():
    c1, c_max, c_min, f1, f2 = 50.0, 100.0, 1.0, 0.5, 2.0
    g = np.linspace(0, 200, 20001)
    _, rho = solve_damper(c1, c_max, c_min, f1, f2, g)
    steps = np.diff(rho * g) / np.diff(g)
    assert (steps > 0).all()
    assert steps.max() <= 1 / (1 + c1 / c_max) * (1 + 1e-9)  # the stiffest branch, and rounding


def test_a_rigid_damper_leaves_the_trial_force():
    sigma, rho = solve_damper(3.0, inf, inf, inf, inf, [0.0, -1.0, 1e9])
    assert np.array_equal(sigma, np.zeros(3)) and np.array_equal(rho, np.ones(3))


def test_without_c1_the_damper_carries_the_trial_force():
    f1, f2, c_max, c_min = 0.5, 2.0, 100.0, 1.0
    g = np.array([0.1, 1.0, 1.9, 5.0])
    sigma, rho = solve_damper(0.0, c_max, c_min, f1, f2, g)
    assert np.array_equal(rho, np.ones(4))
    material = Material("m", 0, 0, c_max, c_min, f1, f2, 0, 1, 1)
    np.testing.assert_allclose(1 / sigma, material.c2(g), rtol=1e-14)


def test_arguments_broadcast():
    sigma, rho = solve_damper(np.array([[1.0], [2.0]]), 8.0, 1.0, 0.5, 2.0, np.array([0.1, 1.5, -90.0]))
    assert sigma.shape == rho.shape == (2, 3)
    for row, c1 in enumerate((1.0, 2.0)):
        for column, g in enumerate((0.1, 1.5, -90.0)):
            assert (sigma[row, column], rho[row, column]) == solve_damper(c1, 8.0, 1.0, 0.5, 2.0, g)


@pytest.mark.parametrize("ratio", [1e2, 1e4, 1e6])
def test_with_large_c1_the_two_dampers_are_c2_alone(ratio):
    """Equation (8): c1 c2 / (c1 + c2) differs from c2 by the part c2 / (c1 + c2)."""
    c2 = 3.0
    _, rho = solve_damper(ratio * c2, c2, c2, inf, inf, 1.0)
    assert rho * ratio * c2 == pytest.approx(c2, rel=1.0 / ratio)
    assert rho * ratio * c2 != pytest.approx(c2, rel=0.5 / ratio)


POSITIVE = "{} must be a finite number above 0, not {!r}"
NOT_NEGATIVE = "{} must be a finite number of at least 0, not {!r}"
ZERO_ALLOWED = {"c1", "f1", "a_min", "a_max", "a0"}


@pytest.mark.parametrize("preset", VALID)
@pytest.mark.parametrize("value", [-1.0, math.nan, inf, "3", True, None])
def test_each_parameter_must_be_a_finite_number(preset, value):
    parameters = dict(VALID[preset])
    if preset.startswith("rheological"):
        parameters |= dict(a_min=0.0, a_max=1.0, a0=0.5)
    for name in parameters:
        zero_allowed = name in ZERO_ALLOWED and (preset, name) != ("plastic-force", "c1")
        with pytest.raises(InputError) as error:
            PRESETS[preset]("m", **parameters | {name: value})
        assert str(error.value) == (NOT_NEGATIVE if zero_allowed else POSITIVE).format(name, value)


@pytest.mark.parametrize(
    ("preset", "name"),
    [
        ("viscoelastic", "k"),
        ("plastic", "c_damper"),
        ("rheological", "k"),
        ("rheological", "c2"),
        ("rheological-force", "f2"),
        ("rheological-force", "c_max"),
        ("rheological-force", "c_min"),
        ("plastic-force", "c1"),
    ],
)
def test_zero_where_it_has_no_meaning(preset, name):
    with pytest.raises(InputError) as error:
        PRESETS[preset]("m", **VALID[preset] | {name: 0.0})
    assert str(error.value) == POSITIVE.format(name, 0.0)


@pytest.mark.parametrize(
    ("preset", "change", "message"),
    [
        ("rheological", dict(a_max=1.5), "a_max must be at most 1, not 1.5"),
        ("rheological", dict(a0=1.1), "a0 must be at most 1, not 1.1"),
        ("rheological", dict(a_min=0.6, a_max=0.4), "a_min must be at most a_max = 0.4, not 0.6"),
        ("rheological", dict(a_min=0.6), "a0 must lie between a_min = 0.6 and a_max = 1.0, not 0.5"),
        ("rheological-force", dict(a_max=0.4), "a0 must lie between a_min = 0.0 and a_max = 0.4, not 0.5"),
        ("rheological-force", dict(f1=2.0), "f2 must be above f1 = 2.0, not 2.0"),
        ("plastic-force", dict(f1=3.0), "f2 must be above f1 = 3.0, not 2.0"),
        ("plastic-force", dict(c_min=200.0), "c_min must be at most c_max = 100.0, not 200.0"),
    ],
)
def test_parameters_must_fit_each_other(preset, change, message):
    with pytest.raises(InputError) as error:
        PRESETS[preset]("m", **VALID[preset] | change)
    assert str(error.value) == message


def test_an_error_can_be_put_under_a_path():
    assert str(InputError("k must be 1, not 2").under("materials.gel")) == "materials.gel.k must be 1, not 2"
