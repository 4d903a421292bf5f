"""Damper laws: c2 as a constant or as a function of the force. A new law is a new subclass of `Damper`.

In series with the Voigt part's damper c1, a damper c2 leaves the edge the share rho of its trial force g, and extends
by sigma g. Where c2 depends on the force |f| = rho(|f|) |g|, both are functions of |g| all the same, because c2 never
rises with |f|: |f| (1 + c1 / c2(|f|)) = |g| has one root.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from math import inf

import numpy as np

from golden.physics.checks import check_number
from golden.support.errors import InputError

ROUNDS = 100  # Newton takes 2 to 12 of them, unless f1 and f2 are all but equal
ROUNDING = 1e-9
FAINTEST = 1e-100  # of c_min: a branch continued far past g2 would fall below every float otherwise


def series(c1, c2):
    """Return (rho, sigma) = (c2 / (c1 + c2), 1 / (c1 + c2)) of two dampers in series; (1, 0) for c2 = inf."""
    return 1 / (1 + c1 / c2), 1 / (c1 + c2)


def trial_force(f, c1, c2):
    """Return the trial force at which an edge carries the force ``f``: f / rho."""
    return f * (1 + c1 / c2)


def restore(law: str, parameters: dict[str, float]) -> Damper:
    """Return the damper with the parameters that `dataclasses.asdict` gave, its law by the name of its class."""
    laws = {kind.__name__: kind for kind in Damper.__subclasses__()}
    if law not in laws:
        raise InputError(f"law must be one of {', '.join(laws)}, not {law!r}")
    return laws[law](**parameters)


class Damper(ABC):
    """A law c2(|f|) in three branches: ``c_max`` up to the force ``f1``, a smooth one, ``c_min`` from ``f2`` on.

    The middle branch is c_max exp(-fall(|f|)), where ``fall`` rises from 0 at f1 to ln(c_max / c_min) at f2. The
    formula must hold a little beyond f1 and f2 too: the circuit's table continues the branch past both ends, so that
    none of its segments contains a kink. A law is a frozen dataclass whose fields are its parameters, all numbers.

    Attributes
    ----------
    c_max, c_min : float
        Coefficients (N s/m) at small and at large forces.
    f1, f2 : float
        Forces (N) at which the middle branch begins and ends.
    force_dependent : bool
        False for a law that is one constant.
    """

    c_max: float
    c_min: float
    f1: float
    f2: float
    force_dependent = True

    @abstractmethod
    def fall(self, f):
        """Return ln(c_max / c2) on the middle branch at the force ``f`` >= 0 (N)."""

    @abstractmethod
    def fall_rate(self, f):
        """Return the derivative of `fall` (1/N). ``f`` times it must not fall with ``f``: `softest` is then at f2."""

    @property
    def softest(self) -> float:
        """Smallest d|f| / d(rate of extension) (N s/m), just below f2: less than c_min, because c2 falls with |f|."""
        return self.c_min / (1 + self.fall_rate(self.f2) * self.f2)

    def c2(self, f) -> np.ndarray:
        """Return the coefficient (N s/m) at the force ``f`` (N, any shape and sign)."""
        size = np.abs(np.asarray(f, dtype=float))
        middle = self.c_max * np.exp(-self.fall(np.clip(size, self.f1, self.f2)))
        return np.where(size <= self.f1, self.c_max, np.where(size < self.f2, middle, self.c_min))

    def knees(self, c1: float) -> tuple[float, float]:
        """Return the trial forces (g1, g2) at which the middle branch begins and ends (N)."""
        return trial_force(self.f1, c1, self.c_max), trial_force(self.f2, c1, self.c_min)

    def rho_sigma(self, c1: float, g) -> tuple[np.ndarray, np.ndarray]:
        """Return rho and sigma (m/(N s)) at the trial force ``g`` = k (a l - L) + c1 dl/dt (N, any shape)."""
        size = np.abs(np.asarray(g, dtype=float))
        g1, g2 = self.knees(c1)
        c2 = np.where(size < g2, self.c_max, self.c_min).astype(float)
        middle = (size > g1) & (size < g2)
        if middle.any():
            c2[middle] = self._middle_c2(c1, size[middle])
        return series(c1, c2)

    def middle_rho_sigma(self, c1: float, size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return rho and sigma of the middle branch at the trial forces ``size`` > 0, continued past both knees."""
        return series(c1, np.maximum(self._middle_c2(c1, size), FAINTEST * self.c_min))

    def _middle_c2(self, c1: float, size: np.ndarray) -> np.ndarray:
        """Solve f (1 + c1 / c2(f)) = size by Newton's method on its logarithm with ln f unknown.

        Inside the branch it comes down to the root from above and never passes it. Where it would leave the interval
        that is known to hold the root, as it may far beyond g2, it halves that instead.
        """
        stiff = c1 / self.c_max
        low, high = np.zeros_like(size), size
        f = np.minimum(self.f2, size / (1 + stiff))
        with np.errstate(over="ignore", invalid="ignore"):
            for _ in range(ROUNDS):
                ratio = stiff * np.exp(self.fall(f))  # c1 / c2
                excess = f * (1 + ratio) / size
                above = excess > 1
                low, high = np.where(above, low, f), np.where(above, f, high)
                step = np.log(excess) / (1 + ratio / (1 + ratio) * self.fall_rate(f) * f)
                f = f * np.exp(-step)
                inside = (low * (1 - ROUNDING) <= f) & (f <= high * (1 + ROUNDING))
                if not inside.all():
                    f = np.where(inside, f, (low + high) / 2)
                elif (np.abs(step) * (1 + self.fall_rate(f) * f) < 1e-8).all():
                    break  # the next step is about its square: beyond float64
            return self.c_max * np.exp(-self.fall(f))


@dataclass(frozen=True)
class Linear(Damper):
    """One coefficient c (N s/m) at every force; inf for a rigid damper."""

    c: float

    f1 = f2 = inf
    force_dependent = False

    @property
    def c_max(self) -> float:
        return self.c

    @property
    def c_min(self) -> float:
        return self.c

    @property
    def softest(self) -> float:
        return self.c

    def fall(self, f):
        return 0.0

    def fall_rate(self, f):
        return 0.0


@dataclass(frozen=True)
class Exponential(Damper):
    """Equation (7): c_max up to f1, A exp(-B f) between, c_min from f2 on.

    Continuity at f1 and f2 gives B = ln(c_max / c_min) / (f2 - f1). A = c_max exp(B f1) overflows: it isn't used.
    """

    f1: float
    f2: float
    c_max: float
    c_min: float

    def __post_init__(self):
        check_number("f1", self.f1, positive=False)
        check_number("f2", self.f2)
        if not self.f1 < self.f2:
            raise InputError(f"f2 must be above f1 = {self.f1!r}, not {self.f2!r}")
        check_number("c_max", self.c_max)
        check_number("c_min", self.c_min)
        if self.c_min > self.c_max:
            raise InputError(f"c_min must be at most c_max = {self.c_max!r}, not {self.c_min!r}")

    @cached_property
    def decay(self) -> float:
        """B (1/N)."""
        return np.log(self.c_max / self.c_min) / (self.f2 - self.f1)

    def fall(self, f):
        return self.decay * (f - self.f1)

    def fall_rate(self, f):
        return self.decay
