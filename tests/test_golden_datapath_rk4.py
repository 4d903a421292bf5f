"""The Runge-Kutta method as data, and a stage of it in integers."""

from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from golden.datapath.rk4 import RK4, Tableau, rk4, rk4_early, sixth, weigh
from golden.numbers.qarray import QArray
from golden.numbers.qformat import BIT, Q, unsigned

F = Fraction


def test_the_tableau_is_of_fourth_order():
    """Butcher's eight order conditions, for a method whose stage s uses only stage s - 1."""
    a, b, c = RK4.reach, RK4.weight, (F(0), *RK4.reach)
    stages = range(RK4.stages)
    assert sum(b) == 1
    assert sum(b[s] * c[s] for s in stages) == F(1, 2)
    assert sum(b[s] * c[s] ** 2 for s in stages) == F(1, 3)
    assert sum(b[s] * a[s - 1] * c[s - 1] for s in stages[1:]) == F(1, 6)
    assert sum(b[s] * c[s] ** 3 for s in stages) == F(1, 4)
    assert sum(b[s] * c[s] * a[s - 1] * c[s - 1] for s in stages[1:]) == F(1, 8)
    assert sum(b[s] * a[s - 1] * c[s - 1] ** 2 for s in stages[1:]) == F(1, 12)
    assert sum(b[s] * a[s - 1] * a[s - 2] * c[s - 2] for s in stages[2:]) == F(1, 24)


@pytest.mark.parametrize(
    ("reach", "weight", "message"),
    [
        ((F(1, 2),), (F(1, 2), F(1, 3)), "weights must add up to 1, not 5/6"),
        ((F(1, 2),), (F(1, 2), F(1, 4), F(1, 4)), "reach must have 2 entries, not 1"),
    ],
)
def test_coefficients_that_do_not_belong_together_are_refused(reach, weight, message):
    with pytest.raises(ValueError, match=f"^{message}$"):
        Tableau(reach, weight)


@pytest.mark.parametrize(
    ("reach", "weight", "message"),
    [
        ((F(1),), (F(1, 2), F(1, 2)), "weights must be 1/6 or 1/3, not 1/2: a stage can only double a slope"),
        ((F(2, 3),), (F(1, 4), F(3, 4)), "reach must be 1/2 or 1, not 2/3: a stage can only halve a slope"),
        (
            (F(1, 3), F(2, 3), F(1)),
            (F(1, 8), F(3, 8), F(3, 8), F(1, 8)),
            "reach must be 1/2 or 1, not 1/3: a stage can only halve a slope",
        ),
        ((F(1, 2), F(1, 2)), (F(1, 2), F(1, 3), F(1, 6)), "weights must be 1/6 or 1/3, not 1/2: a stage can only"),
        ((F(1), F(1)), (F(1, 3), F(1, 3), F(1, 3)), "the last weight must be 1/6, not 1/3: the last slope is not"),
    ],
    ids=["Heun", "Ralston", "3/8 rule", "weights of 1/2", "last weight of 1/3"],
)
def test_a_method_that_the_stages_cannot_compute_is_refused(reach, weight, message):
    """They computed something else: y' = -y from 1 to 0.83, 0.83 and 0.67 in a step of 1, instead of about 0.4."""
    with pytest.raises(ValueError, match=f"^{message}"):
        Tableau(reach, weight)


FIVE = Tableau((F(1, 2), F(1), F(1, 2), F(1)), tuple(F(w, 6) for w in (2, 1, 1, 1, 1)))


@pytest.mark.parametrize("rule", [rk4, rk4_early])
@pytest.mark.parametrize("tableau", [RK4, FIVE], ids=["classical", "five stages"])
def test_the_stages_compute_what_the_tableau_says(rule, tableau):
    """y' = -y from 1 with a step of 1; the classical method gives 1 - 1 + 1/2 - 1/6 + 1/24 = 0.375."""
    y, slopes = F(1), []
    for number in range(tableau.stages):
        slopes.append(-y)
        y = 1 + (tableau.reach[number] * slopes[-1] if number < tableau.stages - 1 else 0)
    exact = 1 + sum(w * k for w, k in zip(tableau.weight, slopes, strict=True))
    assert tableau != RK4 or exact == F(3, 8)

    q = Q(3, 30)
    base = value = QArray(np.int64(1 << 30), q, None)
    total = QArray(np.int64(0), q, None)
    for number in range(tableau.stages):
        stage = SimpleNamespace(**{n: QArray(np.int64(bit), BIT, None) for n, bit in tableau.stage(number).items()})
        slope = 0 - value
        if number == tableau.stages - 1 and rule is rk4:
            slope = sixth(slope)
        total, value = (x.to(q) for x in rule(stage, base, total, slope))
    assert value.to_float() == pytest.approx(float(exact), abs=1e-8)


def test_the_bits_of_a_stage_say_what_the_tableau_says():
    for number in range(RK4.stages):
        bits = RK4.stage(number)
        assert bits["first"] == (number == 0) and bits["last"] == (number == 3)
        assert RK4.weight[number] == F(2 if bits["double"] else 1, 6)
        if not bits["last"]:
            assert RK4.reach[number] == (F(1, 2) if bits["half"] else 1)


def numbers(rng, width):
    """Return every small number, the neighbours of every power of two, and random ones."""
    powers = [s * (1 << bits) + d for bits in range(width - 1) for s in (-1, 1) for d in (-1, 0, 1)]
    end = 1 << width - 1
    return np.unique([-end, end - 1, *powers, *range(-200, 200), *rng.integers(-end, end, 2000)])


def test_a_sixth_is_a_sixth_within_its_bound(rng):
    for width in (12, 38, 46):
        x = QArray(numbers(rng, width), Q(3, width - 3), None)
        result = sixth(x)
        places = 2 ** (result.fmt.frac_bits - x.fmt.frac_bits)
        for raw, got in zip(x.raw.tolist(), result.raw.tolist(), strict=True):
            assert abs(F(got, places) - F(raw, 6)) <= F(abs(raw), 6 * 2**32) + F(1, 2**6)


def test_a_sixth_of_nothing_is_nothing_and_of_little_is_not_lost():
    x = QArray(np.array([0, 1, -1, 6]), Q(3, 33), None)
    assert sixth(x).raw[0] == 0
    np.testing.assert_allclose(sixth(x).to_float() / x.fmt.lsb, [0, 1 / 6, -1 / 6, 1], atol=2**-6)


@pytest.mark.parametrize("rule", [rk4, rk4_early])
def test_four_stages_make_a_step(rule, rng):
    q = Q(2, 30)
    base = QArray(rng.integers(-(2**30), 2**30, 500), q, None)
    slopes = [QArray(rng.integers(-(2**28), 2**28, 500), q, None) for _ in range(4)]
    total, exact = QArray(rng.integers(-5, 5, 500), q, None), base.to_float()
    for number, slope in enumerate(slopes):
        stage = SimpleNamespace(**{name: QArray(np.int64(b), BIT, None) for name, b in RK4.stage(number).items()})
        weighted = sixth(slope) if number == 3 and rule is rk4 else slope
        total, value = rule(stage, base, total, weighted)
        if number < 3:  # exact: where the next stage is evaluated
            assert np.array_equal(value.to_float(), exact + float(RK4.reach[number]) * slope.to_float())
    step = sum(float(w) * k.to_float() for w, k in zip(RK4.weight, slopes, strict=True))
    bound = 2 * (2**-6 * q.lsb + 2**-32 * np.abs(step))  # that of a sixth, for the last slope and for the others
    assert (np.abs(value.to_float() - (exact + step)) <= bound + 4 * np.finfo(float).eps).all()


def test_a_factor_is_weighed_in_the_last_stage_only(rng):
    q = unsigned(0, 18)
    x = QArray(rng.integers(1 << 17, 1 << 18, 1000), q, None)
    for number in range(RK4.stages):
        stage = SimpleNamespace(**{name: QArray(np.int64(b), BIT, None) for name, b in RK4.stage(number).items()})
        factor, shift = weigh(stage, x)
        weight = float(RK4.weight[-1]) if number == RK4.stages - 1 else 1.0
        value = factor.to_float() * 2.0 ** -shift.to_float()
        assert factor.fmt == q and shift.to_float() == (2 if weight < 1 else 0)
        assert (np.abs(value - weight * x.to_float()) <= (q.lsb / 8 + 2.0**-32 if weight < 1 else 0)).all()
