"""Another material in the middle of a deformation: the force does not jump, the ratio keeps its limits."""

import itertools

import numpy as np
import pytest
from sim_objects import MATERIALS

from golden.physics.switch import switch_material


def force(m, length, rate, ratio, natural):
    """Return -f of the series law."""
    g = m.k * (ratio * length - natural) + m.c1 * rate
    return m.rho_sigma(g)[0] * g


def state(rng, m, count=200):
    """Return (l, dl/dt, a, L) of edges with forces on all branches of the damper."""
    ratio = rng.uniform(m.a_min, m.a_max, count)
    length = rng.uniform(0.01, 0.03, count)
    return length, rng.uniform(-0.1, 0.1, count), ratio, ratio * length * rng.uniform(0.7, 1.3, count)


@pytest.mark.parametrize("names", list(itertools.product(MATERIALS, repeat=2)), ids="-".join)
def test_the_force_does_not_jump(names, rng):
    old, new = (MATERIALS[name] for name in names)
    length, rate, ratio, natural = state(rng, old)
    after = switch_material(old, new, length, rate, ratio, natural)
    assert (new.a_min <= after[0]).all() and (after[0] <= new.a_max).all()
    if new.k:
        before = force(old, length, rate, ratio, natural)
        assert np.allclose(force(new, length, rate, *after), before, rtol=1e-9, atol=1e-12)
        assert np.ptp(before) > 0.1


@pytest.mark.parametrize("name", MATERIALS)
def test_to_the_same_material_changes_nothing(name, rng):
    m = MATERIALS[name]
    length, rate, ratio, natural = state(rng, m)
    if not m.k:
        natural = ratio * length
    after = switch_material(m, m, length, rate, ratio, natural)
    assert np.allclose(after[0], ratio) and np.allclose(after[1], natural, atol=1e-10)


def test_a_ratio_at_its_limit_begins_anew():
    old, new = MATERIALS["viscoelastic"], MATERIALS["rheological-force"]
    ratio, natural = switch_material(old, new, 0.02, 0.0, 1.0, 0.02)
    assert ratio == new.a0 and natural == pytest.approx(new.a0 * 0.02)  # without a force it is at rest as it is


def test_without_a_spring_the_dampers_give_the_force():
    clay = MATERIALS["plastic"]
    ratio, natural = switch_material(MATERIALS["viscoelastic"], clay, 0.02, 0.1, 1.0, 0.03)
    assert force(clay, 0.02, 0.1, ratio, natural) == pytest.approx(clay.c1 / 2 * 0.1)
