"""Materials: parameters of the three-element model, and presets that check what the user gives."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from golden.physics.checks import check_number
from golden.physics.dampers import Damper, Exponential, Linear, series, trial_force
from golden.support.errors import InputError


@dataclass(frozen=True)
class Material:
    """One three-element model: a Voigt part (k, c1), a of the length, in series with a damper.

    k in N/m, c1 in N s/m; the ratios have no unit. Build one with a preset below: they check what they are given.
    """

    name: str
    k: float
    c1: float
    damper: Damper
    a_min: float
    a_max: float
    a0: float

    @property
    def knees(self) -> tuple[float, float]:
        """Trial forces (N) at which the damper's middle branch begins and ends."""
        return self.damper.knees(self.c1)

    def rho_sigma(self, g) -> tuple[np.ndarray, np.ndarray]:
        """Return rho and sigma at the trial force ``g``: `golden.physics.dampers.Damper.rho_sigma`."""
        return self.damper.rho_sigma(self.c1, g)

    def trial_force(self, f) -> np.ndarray:
        """Return the trial force (N) at which an edge carries the force ``f``: the inverse of rho g."""
        return trial_force(f, self.c1, self.damper.c2(f))


def viscoelastic(name: str, k: float, c1: float) -> Material:
    """Return a Voigt part alone: the damper is rigid and the ratio stays 1, so the object returns to its shape."""
    check_number("k", k)
    check_number("c1", c1, positive=False)
    return Material(name, k, c1, Linear(inf), 1.0, 1.0, 1.0)


def plastic(name: str, c_damper: float) -> Material:
    """Return a damper alone, as two equal ones in series: c1 c2 / (c1 + c2) = c_damper, equation (6).

    The ratio has no effect on the force (k = 0) and keeps its value a0 = c2 / (c1 + c2).
    """
    check_number("c_damper", c_damper)
    c = 2 * c_damper
    return Material(name, 0.0, c, Linear(c), 0.0, 1.0, 0.5)


def rheological(
    name: str, k: float, c1: float, c2: float, a_min: float = 0.0, a_max: float = 1.0, a0: float = 0.5
) -> Material:
    """Return a Voigt part and a damper in series: the object comes back part of the way."""
    check_number("k", k)
    check_number("c1", c1, positive=False)
    check_number("c2", c2)
    _ratios(a_min, a_max, a0)
    return Material(name, k, c1, Linear(c2), a_min, a_max, a0)


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
    """Return a rheological material whose damper is equation (7): stiff up to the force f1, soft from f2 on."""
    check_number("k", k)
    check_number("c1", c1, positive=False)
    damper = _exponential(f1, f2, c_max, c_min)
    _ratios(a_min, a_max, a0)
    return Material(name, k, c1, damper, a_min, a_max, a0)


def plastic_force(name: str, c1: float, f1: float, f2: float, c_max: float, c_min: float) -> Material:
    """Return a damper that follows equation (7): with c1 >> c2, equation (8), the two in series behave as c2 alone.

    The ratio has no effect on the force (k = 0); a0 is the value that stays constant at small forces.
    """
    check_number("c1", c1)
    damper = _exponential(f1, f2, c_max, c_min)
    rho, _ = series(c1, c_max)
    return Material(name, 0.0, c1, damper, 0.0, 1.0, rho)


PRESETS = {
    "viscoelastic": viscoelastic,
    "plastic": plastic,
    "rheological": rheological,
    "rheological-force": rheological_force,
    "plastic-force": plastic_force,
}


def _exponential(f1: float, f2: float, c_max: float, c_min: float) -> Damper:
    """Return the damper of equation (7), a linear one if c_max and c_min are equal."""
    damper = Exponential(f1, f2, c_max, c_min)
    return Linear(c_max) if c_max == c_min else damper


def _ratios(a_min: float, a_max: float, a0: float) -> None:
    for name, value in (("a_min", a_min), ("a_max", a_max), ("a0", a0)):
        check_number(name, value, positive=False)
        if value > 1:
            raise InputError(f"{name} must be at most 1, not {value!r}")
    if a_min > a_max:
        raise InputError(f"a_min must be at most a_max = {a_max!r}, not {a_min!r}")
    if not a_min <= a0 <= a_max:
        raise InputError(f"a0 must lie between a_min = {a_min!r} and a_max = {a_max!r}, not {a0!r}")
