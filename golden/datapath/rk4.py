"""The classical Runge-Kutta method as data, and one stage of it over any number type.

In step units (the time step is 1) a stage needs shifts and one division by six.
"""

from dataclasses import dataclass
from fractions import Fraction

from golden.numbers.qformat import Q

HALF, SIXTH = Fraction(1, 2), Fraction(1, 6)


@dataclass(frozen=True)
class Tableau:
    """Coefficients of a Runge-Kutta method that the stages below can compute.

    Parameters
    ----------
    reach : tuple of Fraction
        Stage s is evaluated at ``base + reach[s - 1] * slope[s - 1]``.
    weight : tuple of Fraction
        The step is ``sum(weight * slope)``.

    Raises
    ------
    ValueError
        If the lengths don't match, the weights don't add up to 1, or the bits of a stage can't express a coefficient.
    """

    reach: tuple[Fraction, ...]
    weight: tuple[Fraction, ...]

    def __post_init__(self):
        if sum(self.weight) != 1:
            raise ValueError(f"weights must add up to 1, not {sum(self.weight)}")
        if len(self.reach) != len(self.weight) - 1:
            raise ValueError(f"reach must have {len(self.weight) - 1} entries, not {len(self.reach)}")
        for reach in self.reach:
            if reach not in (HALF, 1):
                raise ValueError(f"reach must be 1/2 or 1, not {reach}: a stage can only halve a slope")
        for weight in self.weight:
            if weight not in (SIXTH, 2 * SIXTH):
                raise ValueError(f"weights must be 1/6 or 1/3, not {weight}: a stage can only double a slope")
        if self.weight[-1] != SIXTH:
            raise ValueError(f"the last weight must be 1/6, not {self.weight[-1]}: the last slope is not doubled")

    @property
    def stages(self) -> int:
        return len(self.weight)

    def stage(self, number: int) -> dict[str, int]:
        """Return the bits that tell the datapath which stage it is in."""
        last = number == self.stages - 1
        return {
            "first": int(number == 0),
            "last": int(last),
            "half": int(not last and self.reach[number] == HALF),
            "double": int(self.weight[number] == 2 * SIXTH),
        }


RK4 = Tableau(reach=(HALF, HALF, Fraction(1)), weight=(SIXTH, 2 * SIXTH, 2 * SIXTH, SIXTH))


def rk4(stage, base, total, slope):
    """Return (weighted sum of the slopes so far, value at which the next stage is evaluated).

    In the last stage ``slope`` is a sixth of the slope (`weigh`), the value is the new base and the sum means nothing.
    So the critical path from a slope to a value is one addition in every stage. Only `sixth` rounds.
    """
    start = stage.last.select(base + sixth(total), base)
    value = start + stage.half.select(slope.scale(-1), slope)
    return summed(stage, total, slope), value


def rk4_early(stage, base, total, slope):
    """Return the same as `rk4`, for a slope that is known early: it is whole in the last stage too, and the sum is
    divided by six."""
    total = summed(stage, total, slope)
    change = stage.last.select(sixth(total), stage.half.select(slope.scale(-1), slope))
    return total, base + change


def summed(stage, total, slope):
    """Return the weighted sum of a step's slopes, including this one."""
    return stage.first.select(0, total) + stage.double.select(slope.scale(1), slope)


def weigh(stage, factor):
    """Return a slope's ``factor``, in the last stage a sixth of it, and a shift to be added to the slope's."""
    return stage.last.select(sixth(factor).scale(2), factor).to(factor.fmt), stage.last.scale(1)


WIDEST = 54
"""Bits of a sixth at the most: the sixth of a state word would have more if it were not rounded on the way."""


def sixth(x):
    """Return ``x / 6`` to within 2**-32 of it and 2**-6 of its LSB: 1/3 = 5 * 17 * 257 * (1 + 2**-16 + ...) / 2**16."""
    third = x + x.scale(2)
    third = third + third.scale(4)
    third = (third + third.scale(8)).scale(-16)
    rest = third.scale(-16)
    if rest.fmt.frac_bits + x.fmt.int_bits > WIDEST:
        guarded = Q(x.fmt.int_bits, x.fmt.frac_bits + 6)
        third = third.to(guarded)
        rest = third.scale(-16).to(guarded)
    return (third + rest).scale(-1)
