"""Materials: parameters of the three-element model, presets, and the damper's law, equations (4) to (8)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from golden.support.errors import InputError


@dataclass(frozen=True)
class Material:
    """One three-element model: a Voigt part (k, c1), a of the length, in series with a damper c2.

    k in N/m, c1 and c2 in N s/m, forces f1 and f2 in N; the ratios have no unit. The damper is equation (7):
    c_max up to the force f1, c_min from f2 on, exponential between. A linear damper has c_max = c_min = c2
    and f1 = f2 = inf; a rigid one (viscoelastic) has c2 = inf. Build one with a preset below: they check what
    they are given.
    """

    name: str
    k: float
    c1: float
    c_max: float
    c_min: float
    f1: float
    f2: float
    a_min: float
    a_max: float
    a0: float

    @property
    def linear(self) -> bool:
        """Whether the damper has one coefficient at every force."""
        return self.c_max == self.c_min

    def c2(self, f) -> np.ndarray:
        """Damper coefficient (N s/m) at the force `f` (N, any shape and sign), equation (7)."""
        size = np.abs(np.asarray(f, dtype=float))
        if self.linear:
            return np.full_like(size, self.c_max)
        beyond = np.clip(size, self.f1, self.f2) - self.f1
        falling = self.c_max * np.exp(-decay(self.c_max, self.c_min, self.f1, self.f2) * beyond)
        return np.where(size < self.f2, falling, self.c_min)


def decay(c_max, c_min, f1, f2):
    """B of equation (7) in 1/N, from continuity at f1 and f2. (A = c_max exp(B f1) overflows: not used.)"""
    return np.log(c_max / c_min) / (f2 - f1)


def solve_damper(c1, c_max, c_min, f1, f2, g) -> tuple[np.ndarray, np.ndarray]:
    """(sigma, rho) = (1 / (c1 + c2), c2 / (c1 + c2)) for the c2 of (7) at the force the edge really carries.

    `g` is the trial force k (a l - L) + c1 dl/dt (N); all arguments broadcast. The force satisfies
    |f| (1 + c1 / c2(|f|)) = |g|, whose left side rises with |f|: one root, and the branch it lies in follows
    from |g| alone. c2 = inf gives sigma = 0 and rho = 1.
    """
    size = np.abs(np.asarray(g, dtype=float))
    c1, c_max, c_min, f1, f2, size = np.broadcast_arrays(c1, c_max, c_min, f1, f2, size)
    g1 = f1 * (1 + c1 / c_max)
    g2 = f2 * (1 + c1 / c_min)
    c2 = np.where(size < g2, c_max, c_min).astype(float)
    middle = (size > g1) & (size < g2)
    if middle.any():
        c2[middle] = _middle_branch(*(p[middle] for p in (c1, c_max, c_min, f1, f2, size)))
    return 1 / (c1 + c2), 1 / (1 + c1 / c2)


def _middle_branch(c1, c_max, c_min, f1, f2, size) -> np.ndarray:
    """c2 between g1 and g2, by Newton's method on ln(|f| (1 + c1 / c2(|f|))) = ln |g| with ln |f| unknown.

    The left side is convex and rises, and the iteration starts above the root: it comes down to it and never
    passes it, so nothing needs to be bracketed. It takes 2 to 12 rounds, unless f1 and f2 are all but equal.
    """
    b, stiff = decay(c_max, c_min, f1, f2), c1 / c_max
    f = np.minimum(f2, size / (1 + stiff))
    for _ in range(64):
        ratio = stiff * np.exp(b * (f - f1))  # c1 / c2
        step = np.log(f * (1 + ratio) / size) / (1 + ratio / (1 + ratio) * b * f)
        f = f * np.exp(-step)
        if (np.abs(step) * (1 + b * f) < 1e-8).all():  # the next step is its square, beyond float64
            break
    return c_max * np.exp(-b * (f - f1))


def viscoelastic(name: str, k: float, c1: float) -> Material:
    """A Voigt part alone: the damper is rigid and the ratio stays 1, so the object returns to its shape."""
    _number("k", k)
    _number("c1", c1, positive=False)
    return Material(name, k, c1, math.inf, math.inf, math.inf, math.inf, 1.0, 1.0, 1.0)


def plastic(name: str, c_damper: float) -> Material:
    """A damper alone, as two equal ones in series: c1 c2 / (c1 + c2) = c_damper, equation (6).

    The ratio has no effect on the force (k = 0) and keeps its value a0 = c2 / (c1 + c2).
    """
    _number("c_damper", c_damper)
    c = 2 * c_damper
    return Material(name, 0.0, c, c, c, math.inf, math.inf, 0.0, 1.0, 0.5)


def rheological(
    name: str, k: float, c1: float, c2: float, a_min: float = 0.0, a_max: float = 1.0, a0: float = 0.5
) -> Material:
    """Voigt part and damper in series: comes back part of the way."""
    _number("k", k)
    _number("c1", c1, positive=False)
    _number("c2", c2)
    _ratios(a_min, a_max, a0)
    return Material(name, k, c1, c2, c2, math.inf, math.inf, a_min, a_max, a0)


def rheological_force(
    name: str,
    k: float,
    c1: float,
    f1: float,
    f2: float,
    c_max: float,
    c_min: float,
    a_min: float = 0.0,
    a_max: float = 1.0,
    a0: float = 0.5,
) -> Material:
    """A rheological material whose damper is equation (7): stiff up to the force f1, soft from f2 on."""
    _number("k", k)
    _number("c1", c1, positive=False)
    _damper(f1, f2, c_max, c_min)
    _ratios(a_min, a_max, a0)
    return Material(name, k, c1, c_max, c_min, f1, f2, a_min, a_max, a0)


def plastic_force(name: str, c1: float, f1: float, f2: float, c_max: float, c_min: float) -> Material:
    """A damper that follows equation (7): with c1 >> c2, equation (8), the two in series behave as c2 alone.

    The ratio has no effect on the force (k = 0); a0 is the value that stays constant at small forces.
    """
    _number("c1", c1)
    _damper(f1, f2, c_max, c_min)
    return Material(name, 0.0, c1, c_max, c_min, f1, f2, 0.0, 1.0, c_max / (c1 + c_max))


PRESETS = {
    "viscoelastic": viscoelastic,
    "plastic": plastic,
    "rheological": rheological,
    "rheological-force": rheological_force,
    "plastic-force": plastic_force,
}


def _number(name: str, value: float, positive: bool = True) -> None:
    real = isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)
    if not real or not math.isfinite(value) or value < 0 or (positive and value == 0):
        bound = "above" if positive else "of at least"
        raise InputError(f"{name} must be a finite number {bound} 0, not {value!r}")


def _damper(f1: float, f2: float, c_max: float, c_min: float) -> None:
    _number("f1", f1, positive=False)
    _number("f2", f2)
    if not f1 < f2:
        raise InputError(f"f2 must be above f1 = {f1!r}, not {f2!r}")
    _number("c_max", c_max)
    _number("c_min", c_min)
    if c_min > c_max:
        raise InputError(f"c_min must be at most c_max = {c_max!r}, not {c_min!r}")


def _ratios(a_min: float, a_max: float, a0: float) -> None:
    for name, value in (("a_min", a_min), ("a_max", a_max), ("a0", a0)):
        _number(name, value, positive=False)
        if value > 1:
            raise InputError(f"{name} must be at most 1, not {value!r}")
    if a_min > a_max:
        raise InputError(f"a_min must be at most a_max = {a_max!r}, not {a_min!r}")
    if not a_min <= a0 <= a_max:
        raise InputError(f"a0 must lie between a_min = {a_min!r} and a_max = {a_max!r}, not {a0!r}")
