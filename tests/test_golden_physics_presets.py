"""Presets that must be equal to each other, by equations (6) and (8) and by their limits."""

import math

import numpy as np
import pytest
from golden_objects import press_hold_release, scene

from golden.mesh import mesh
from golden.physics.dampers import Linear
from golden.physics.materials import Material, plastic, plastic_force, rheological, rheological_force, viscoelastic
from golden.physics.model import simulate

BLOCK = mesh.rectangle((4, 4), (1.0, 1.0))
inf = math.inf


def squeeze(material):
    phases = press_hold_release(BLOCK, 0.2, (100, 1e-3), 100, 200)
    return simulate(scene(BLOCK, material, 1e-3, phases, mass=0.1))


def difference(p, q):
    return abs(p.x - q.x).max()


@pytest.mark.parametrize("a_min", [0.0, 1.0])
def test_rheological_with_huge_c2_and_ratio_1_is_viscoelastic(a_min):
    expected = squeeze(viscoelastic("gum", 50.0, 2.0))
    distances = [
        difference(expected, squeeze(rheological("gel", 50.0, 2.0, 2.0 * huge, a_min, 1.0, 1.0))) for huge in (1e4, 1e6)
    ]
    # the force is smaller by c1 / c2, the damper yields at f / c2: first order in c1 / c2
    assert distances[0] < 1e-4 and distances[1] < 1e-6
    assert distances[0] / distances[1] == pytest.approx(100, rel=0.02)


def test_dampers_in_series_are_one_damper():
    """Equation (6); a rigid damper in series with c leaves c. Equal up to rounding: 400 steps, unit sizes."""
    expected = squeeze(Material("one", 0.0, 2.0, Linear(inf), 0.0, 1.0, 0.5))
    assert abs(expected.x[-1] - expected.x[0]).max() > 0.1
    for c1, c2 in ((4.0, 4.0), (3.0, 6.0), (2.5, 10.0)):
        both = squeeze(Material("two", 0.0, c1, Linear(c2), 0.0, 1.0, c2 / (c1 + c2)))
        assert difference(both, expected) < 400 * 4 * np.finfo(float).eps
        assert both.a == pytest.approx(c2 / (c1 + c2), abs=400 * 4 * np.finfo(float).eps)
    assert difference(squeeze(plastic("clay", 2.0)), expected) < 400 * 4 * np.finfo(float).eps


def test_the_ratio_of_a_plastic_edge_has_no_effect_on_its_force():
    runs = [squeeze(Material("two", 0.0, 3.0, Linear(6.0), 0.0, 1.0, a0)) for a0 in (0.01, 0.5, 0.99)]
    assert runs[0].a.min() == 0.0 or runs[2].a.max() == 1.0  # a clamp was reached
    assert np.array_equal(runs[0].x, runs[1].x) and np.array_equal(runs[0].x, runs[2].x)


def test_with_large_c1_the_damper_is_c2_alone():
    """Equation (8): the error is first order in c2 / c1."""
    expected = squeeze(Material("one", 0.0, 2.0, Linear(inf), 0.0, 1.0, 0.5))
    in_series = [Material("two", 0.0, 2.0 * ratio, Linear(2.0), 0.0, 1.0, 0.5) for ratio in (1e2, 1e4)]
    distances = [difference(expected, squeeze(material)) for material in in_series]
    assert 0 < distances[0] < 1e-2
    assert distances[0] / distances[1] == pytest.approx(100, rel=0.02)


def test_force_dependent_presets_with_equal_coefficients_are_the_linear_ones():
    same = dict(f1=0.1, f2=0.2, c_max=3.0, c_min=3.0)
    linear = squeeze(rheological("gel", 50.0, 2.0, 3.0))
    assert difference(squeeze(rheological_force("gel", 50.0, 2.0, **same)), linear) == 0
    assert difference(squeeze(plastic_force("clay", 3.0, **same)), squeeze(plastic("clay", 1.5))) == 0


@pytest.mark.parametrize(("f1", "f2", "c2"), [(1e3, 2e3, 9.0), (0.0, 1e-9, 3.0)])
def test_force_dependent_damper_beyond_its_ends_is_linear(f1, f2, c2):
    """Forces all below f1 (up to 10 N here) see c_max, forces above f2 see c_min."""
    varying = squeeze(rheological_force("gel", 50.0, 2.0, f1, f2, c_max=9.0, c_min=3.0))
    assert difference(varying, squeeze(rheological("gel", 50.0, 2.0, c2))) < 1e-9
