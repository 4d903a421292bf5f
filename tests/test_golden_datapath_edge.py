"""One edge in integers: against equations (1) to (3) in float64, its symmetries, and integers that must not change."""

from collections import Counter
from types import SimpleNamespace

import numpy as np
import pytest
from integer_objects import MATERIALS

from golden.datapath import records
from golden.datapath.edge import axis_of, edge, voigt_length
from golden.datapath.formats import Formats
from golden.datapath.rk4 import RK4
from golden.datapath.tables import Tables, inverse_table
from golden.numbers.qarray import QArray
from golden.numbers.qformat import BIT
from sim.encode.coefficients import coefficients
from sim.encode.encode import stack
from sim.encode.units import Units

FMT = Formats()
UNITS = Units(size=0.1, centre=None, dt=2e-4, velocity_shift=7, force=16.0, trial=(16.0,))
EPS = 2.0**-FMT.operand


class Edges:
    """Many edges of one material, each in a state of its own; velocities are differences from a common one."""

    def __init__(self, material, rng, count=20_000, units=UNITS):
        self.material, self.units, self.faults = material, units, Counter()
        self.record, table = coefficients(material, 0, units, FMT, 0)
        self.tables = Tables(FMT, inverse_table(FMT), stack([table.words] if table else [], FMT))
        direction = rng.normal(size=(3, count))
        direction[2, : count // 2] = 0  # half of them in a plane
        direction /= np.linalg.norm(direction, axis=0)
        l = 2.0 ** rng.uniform(-5, 0, count)
        start, v = rng.uniform(-0.5, 0.5, (3, count)), rng.uniform(-0.4, 0.4, (3, count))
        w = rng.uniform(-0.05, 0.05, (3, count)) * 2.0 ** rng.uniform(-6, 0, count)
        self.a = rng.uniform(0.1, 0.9, count)
        self.x = [self.integers(p, FMT.position) for p in (start, start + direction * l)]
        self.v = [self.integers(p, FMT.velocity) for p in (v, v + w)]
        self.ratio = self.integers(self.a, FMT.ratio)
        self.length = self.integers(self.a * l * rng.uniform(0.7, 1.3, count), FMT.length)

    def integers(self, x, q):
        return QArray.from_float(x, q, self.faults).raw

    def number(self, raw, q):
        return QArray(np.asarray(raw, np.int64), q, self.faults)

    def vector(self, raw, q):
        return [self.number(component, q) for component in raw]

    def run(self, swap=False, length=None):
        """Return the quantities of `golden.datapath.edge.edge` in the first stage."""
        record = {name: self.number(self.record[name], q) for name, q in records.material(FMT, 1).items()}
        stage = {name: self.number(bit, BIT) for name, bit in RK4.stage(0).items()}
        ends = [
            SimpleNamespace(x=self.vector(x, FMT.position), v=self.vector(v, FMT.velocity))
            for x, v in zip(self.x, self.v, strict=True)
        ]
        ratio = self.number(self.ratio, FMT.ratio)
        length = self.number(self.length if length is None else length, FMT.length)
        state = SimpleNamespace(length=length, base=ratio, ratio=ratio, total=self.number(0 * self.ratio, FMT.ratio))
        shift = self.number(self.units.velocity_shift, FMT.exponent)
        return edge(
            FMT,
            self.tables,
            SimpleNamespace(**stage),
            shift,
            SimpleNamespace(**record),
            *(ends[::-1] if swap else ends),
            state,
        )

    def exact(self):
        """Solve equations (1) to (3) in float64 and SI, from the integers that the datapath gets."""
        m, size, step = self.material, self.units.size, self.units.dt
        d = np.ldexp((self.x[1] - self.x[0]).astype(float), -FMT.position.frac_bits) * size
        w = np.ldexp((self.v[1] - self.v[0]).astype(float), -FMT.velocity.frac_bits) * self.units.velocity
        a = np.ldexp(self.ratio.astype(float), -FMT.ratio.frac_bits)
        rest = np.ldexp(self.length.astype(float), -FMT.length.frac_bits) * size
        l = np.linalg.norm(d, axis=0)
        u = d / l
        ldot = (u * w).sum(axis=0)
        g = m.k * (a * l - rest) + m.c1 * ldot
        rho, sigma = m.rho_sigma(g)
        if np.isinf(m.damper.c_max):
            adot = (1 - a) * ldot / l  # the limit of (3): the damper part keeps its length
        else:
            c2 = rho / sigma
            adot = (-m.k * (a * l - rest) - (m.c1 * a - c2 * (1 - a)) * ldot) / ((m.c1 + c2) * l)
        f = -m.k * (a * l - rest) - m.c1 * (adot * l + a * ldot)
        if np.isfinite(m.damper.c_max):
            np.testing.assert_allclose(-c2 * (-adot * l + (1 - a) * ldot), f, rtol=1e-9, atol=1e-12)  # equation (2)
        return SimpleNamespace(d=d, w=w, a=a, l=l, rest=rest, u=u, g=g, f=f, adot=adot * step, rho=rho, sigma=sigma)


def bounds(edges, exact):
    """Largest errors of the pull (N) and of adot (1/step), in EPS: half a last place of a signed mantissa.

    A vector's mantissas are 2 EPS each off at most (where they saturate), so the vector 7 EPS of its length; then

    | of                 |     | made of                                                                      |
    |--------------------|-----|------------------------------------------------------------------------------|
    | length             | 11  | d 7, square 1, table 2, rounding 1                                           |
    | direction          | 14  | d 7, square and table 3, rounding 3.5                                        |
    | ldot, of abs(w)    | 25  | direction 14, w 7, rounding 4                                                |
    | stretch            |     | length 11 a l, ratio 1 l, mantissa and coefficient 5 (a l - L)               |
    | f and sigma g      | 5   | mantissa 2, coefficient 1, rounding 2; table 1e-4                            |
    | 1 / l              | 10  | d 7, square 1, table 2                                                       |

    and half a last place of each state word. Where the damper depends on the force, sigma g changes with g by less
    than 1 / c1 and f by less than rho.
    """
    m, e = edges.material, exact
    speed = np.linalg.norm(e.w, axis=0)
    full = edges.units.trial[0]
    stretch = 11 * e.a * e.l + e.l + 5 * np.abs(e.a * e.l - e.rest)
    g = EPS * (m.k * stretch + 26 * m.c1 * speed) + m.k * edges.units.size * FMT.length.lsb + full * FMT.trial.lsb
    table = 1e-4 if m.damper.force_dependent else 0
    pull = e.rho * g + np.abs(e.f) * ((5 + 14) * EPS + table) + edges.units.force * FMT.force.lsb
    creep = (1 / m.c1 if m.damper.force_dependent else e.sigma) * g + (5 * EPS + table) * e.sigma * np.abs(e.g)
    rates = 26 * EPS * speed + creep + edges.units.velocity * FMT.creep.lsb
    adot = rates / e.l * edges.units.dt + (10 + 4) * EPS * np.abs(e.adot) + FMT.ratio.lsb
    return pull, adot


@pytest.mark.parametrize("name", MATERIALS)
def test_force_and_rate_are_those_of_the_equations_within_their_bounds(name, rng):
    edges = Edges(MATERIALS[name], rng)
    got, exact = edges.run(), edges.exact()
    pull = np.array([c.to_float() for c in got["pull"]]) * edges.units.force
    errors = np.linalg.norm(pull + exact.f * exact.u, axis=0), np.abs(got["slope"].to_float() - exact.adot)
    for what, error, bound in zip(("pull", "adot"), errors, bounds(edges, exact), strict=True):
        part = error / bound
        print(f"{name}: error of {what} at most {part.max():.2f} of its bound, {np.median(part):.3f} in the median")
        assert 0.05 < part.max() <= 1  # and the bound is none that anything would keep
    assert np.abs(exact.f).max() > 0.05 and np.abs(exact.adot).max() > 1e-4
    assert not edges.faults


@pytest.mark.parametrize("name", [n for n, m in MATERIALS.items() if m.k])
def test_the_pull_of_the_opposite_trial_force_is_the_opposite_but_for_ties(name, rng):
    edges = Edges(MATERIALS[name], rng)
    edges.v[1] = edges.v[0]
    relaxed = edges.run()["relaxed"].raw
    stretch = rng.integers(-(1 << FMT.operand - 1) + 1, 1 << FMT.operand - 1, len(relaxed))  # which a mantissa holds
    there, back = edges.run(length=relaxed - stretch), edges.run(length=relaxed + stretch)
    assert np.array_equal(there["trial"].raw, -back["trial"].raw) and there["trial"].raw.any()
    for one, other in zip(there["pull"], back["pull"], strict=True):
        off = one.raw + other.raw
        assert np.isin(off, [0, 1]).all() and not off.all()  # a half is rounded up on both sides


@pytest.mark.parametrize("name", MATERIALS)
def test_an_edge_turned_round_pulls_the_other_way_but_for_ties(name, rng):
    """Halves are rounded up, not away from zero, so that a tie in a component of d or w is rounded another way; the
    ends of one edge get the same integer, whichever of them comes first."""
    edges = Edges(MATERIALS[name], rng)
    one, other = edges.run(), edges.run(swap=True)
    exact = edges.exact()
    pull = bounds(edges, exact)[0] / (edges.units.force * FMT.force.lsb)
    sums = np.array([a.raw + b.raw for a, b in zip(one["pull"], other["pull"], strict=True)])
    assert np.mean(sums != 0) < 0.1
    assert (np.linalg.norm(sums, axis=0) <= 2 * pull).all()


@pytest.mark.parametrize("name", MATERIALS)
def test_an_edge_at_rest_is_exactly_at_rest(name, rng):
    edges = Edges(MATERIALS[name], rng)
    edges.v[1] = edges.v[0]
    axis = axis_of(FMT, edges.tables, *(edges.vector(x, FMT.position) for x in edges.x))
    share = edges.number(edges.ratio, FMT.ratio).to(FMT.share)
    got = edges.run(length=voigt_length(FMT, share, axis).raw)
    assert not any(c.raw.any() for c in got["pull"])
    assert not got["slope"].raw.any() and not got["total_next"].raw.any()
    clamped = np.clip(edges.ratio, edges.record["a_min"], edges.record["a_max"])
    assert np.array_equal(got["ratio_next"].raw, clamped)
