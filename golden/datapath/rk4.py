"""The classical Runge-Kutta method as data, and one stage of it over any number type.

In step units (the time step is 1) a stage needs shifts and one division by six.
"""

from dataclasses import dataclass
from fractions import Fraction

from golden.numbers.qformat import Q


@dataclass(frozen=True)
class Tableau:
    """Stage s is evaluated at ``base + reach[s - 1] * slope[s - 1]``; the step is ``sum(weight * slope)``."""

    reach: tuple[Fraction, ...]
    weight: tuple[Fraction, ...]

    def __post_init__(self):
        if sum(self.weight) != 1:
            raise ValueError(f"weights must add up to 1, not {sum(self.weight)}")
        if len(self.reach) != len(self.weight) - 1:
            raise ValueError(f"reach must have {len(self.weight) - 1} entries, not {len(self.reach)}")

    @property
    def stages(self) -> int:
        return len(self.weight)

    def stage(self, number: int) -> dict[str, int]:
        """The bits that tell the datapath which stage it is in."""
        last = number == self.stages - 1
        return {
            "first": int(number == 0),
            "last": int(last),
            "half": int(not last and self.reach[number] == Fraction(1, 2)),
            "double": int(self.weight[number] == 2 * self.weight[0]),
        }


RK4 = Tableau(reach=(Fraction(1, 2), Fraction(1, 2), Fraction(1)), weight=tuple(Fraction(w, 6) for w in (1, 2, 2, 1)))


def rk4(stage, base, total, slope):
    """One stage: (the weighted sum of slopes so far, the value the next stage is evaluated at).

    In the last stage ``slope`` is a sixth of the slope (`weigh`), the value is the new base and the sum means nothing:
    so the long way from a slope to a value is one addition, in every stage. Nothing is rounded but in `sixth`.
    """
    start = stage.last.select(base + sixth(total), base)
    value = start + stage.half.select(slope.scale(-1), slope)
    return summed(stage, total, slope), value


def rk4_early(stage, base, total, slope):
    """`rk4` for a slope that is known early: in the last stage too it comes whole, and the sum is divided by six."""
    total = summed(stage, total, slope)
    change = stage.last.select(sixth(total), stage.half.select(slope.scale(-1), slope))
    return total, base + change


def summed(stage, total, slope):
    """The weighted sum of a step's slopes, with this one."""
    return stage.first.select(0, total) + stage.double.select(slope.scale(1), slope)


def weigh(stage, factor):
    """(``factor`` of a slope, in the last stage a sixth of it; a shift to be added to the slope's)."""
    return stage.last.select(sixth(factor).scale(2), factor).to(factor.fmt), stage.last.scale(1)


WIDEST = 54
"""Bits of a sixth; a state word has more if it is not rounded on the way, an operand has less."""


def sixth(x):
    """``x / 6`` to within 2**-32 of it and 2**-6 of its last place: 1/3 = 5 * 17 * 257 * (1 + 2**-16 + ...) / 2**16."""
    third = x + x.scale(2)
    third = third + third.scale(4)
    third = (third + third.scale(8)).scale(-16)
    rest = third.scale(-16)
    if rest.fmt.frac_bits + x.fmt.int_bits > WIDEST:
        guarded = Q(x.fmt.int_bits, x.fmt.frac_bits + 6)
        third = third.to(guarded)
        rest = third.scale(-16).to(guarded)
    return (third + rest).scale(-1)
