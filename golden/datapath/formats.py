"""The format of every number of the circuit, in one place: the NumPy model, the RTL, the memory images, the
documentation's table and the tests read their widths here.

Units: a *size* is the object's size, a *step* the time step. ``velocity``, ``trial`` and ``force`` are fractions of a
full scale that the host picks per scene (a power of two of sizes per step and so on, `sim.encode.units`), so that
small time steps lose no bits. The circuit sees those powers only as shift counts.
"""

from dataclasses import dataclass, fields
from functools import cached_property

from golden.numbers.qformat import Q, unsigned


@dataclass(frozen=True)
class Formats:
    """The formats that follow from the two word lengths.

    Parameters
    ----------
    operand
        Bits of a multiplier's operand (18: one DSP multiplier).
    state
        Bits of a stored state (36: one block-RAM word).

    Raises
    ------
    ValueError
        If a word length is out of range, or an operand is wider than half a state word (a product must fit a word).
    """

    operand: int = 18
    state: int = 36

    def __post_init__(self):
        if not 12 <= self.operand <= 24:
            raise ValueError(f"operand must be 12 to 24 bits, not {self.operand}")
        if not 24 <= self.state <= 44:
            raise ValueError(f"state must be 24 to 44 bits, not {self.state}")
        if 2 * self.operand > self.state:
            half = self.state // 2
            raise ValueError(f"operand must be at most {half} bits, half of a state word, not {self.operand}")

    def _state(self, int_bits, name, unit):
        return Q(int_bits, self.state - int_bits, name=name, unit=unit)

    def _unsigned(self, int_bits, name, unit):
        return unsigned(int_bits, self.operand - int_bits, name=name, unit=unit)

    # State words
    @cached_property
    def position(self):
        return self._state(3, "position", "size")

    @cached_property
    def velocity(self):
        return self._state(1, "velocity", "velocity full scale")

    @cached_property
    def displacement(self):
        return self._state(-1, "displacement", "size/step")

    @cached_property
    def ratio(self):
        return self._state(2, "ratio", "1")

    @cached_property
    def length(self):
        return self._state(3, "length", "size")

    @cached_property
    def trial(self):
        return self._state(1, "trial force", "trial full scale")

    @cached_property
    def threshold(self):
        """A bound of the magnitude of a trial force."""
        return unsigned(1, self.trial.frac_bits, name="threshold", unit="trial full scale")

    @cached_property
    def creep(self):
        return self._state(2, "creep rate", "velocity full scale")

    @cached_property
    def force(self):
        """The force of an edge on a node: `degree_bits` shorter than its accumulator, so that this can't overflow."""
        return Q(1, self.state - 1 - self.degree_bits, name="force", unit="force full scale")

    degree_bits = 5

    @cached_property
    def accumulator(self):
        return Q(1 + self.degree_bits, self.force.frac_bits, name="accumulator", unit="force full scale")

    # Operands of the multipliers
    @cached_property
    def mantissa(self):
        """A normalised magnitude, or a coefficient."""
        return self._unsigned(0, "mantissa", "2^shift")

    @cached_property
    def square(self):
        return self._unsigned(2, "squared length", "2^shift")

    @cached_property
    def inverse(self):
        return self._unsigned(0, "inverse length", "2^shift")

    @cached_property
    def direction(self):
        return Q(2, self.operand - 2, name="direction", unit="1")

    @cached_property
    def rate(self):
        return Q(2, self.operand - 2, name="length rate", unit="2^shift")

    @cached_property
    def share(self):
        return self._unsigned(1, "share", "1")

    @property
    def dot_frac_bits(self):
        """Fraction bits kept of each product in a dot product; truncation costs less than 1/16 LSB of the result."""
        return self.operand + 4

    # Small integers
    exponent = Q(8, 0, name="exponent", unit="log2")

    # Words of the two tables, two operands long each; indices and fractions of a segment
    inverse_index = unsigned(10, 0)
    damper_index = unsigned(9, 0)
    damper_shift = unsigned(5, 0, name="damper table, shift", unit="log2")

    @cached_property
    def inverse_value(self):
        return unsigned(0, self.operand + 2, name="inverse table, value", unit="2^shift")

    @cached_property
    def inverse_slope(self):
        """Drop per segment; a segment is 2^-8 long and 1 / sqrt(q) falls by at most 1/2 per unit of q >= 1."""
        return unsigned(-8, self.operand + 6, name="inverse table, slope", unit="2^shift")

    @cached_property
    def inverse_fraction(self):
        return unsigned(0, self.square.width - self.inverse_index.width)

    @cached_property
    def damper_value(self):
        return unsigned(0, self.operand - 1, name="damper table, value", unit="2^-shift")

    @cached_property
    def damper_slope(self):
        """Change per segment."""
        return unsigned(-3, self.operand - 1, name="damper table, slope", unit="2^-shift")

    @cached_property
    def damper_fraction(self):
        return unsigned(0, self.operand - 1)

    octave = Q(6, 9, name="octave", unit="octave")
    """A position on the logarithmic axis of |g|: octaves above the full scale, and the finest segments of an octave."""

    @cached_property
    def octave_fraction(self):
        """The bits of a mantissa after its first, which is 1."""
        return unsigned(0, self.mantissa.width - 1)

    fineness = unsigned(4, 0, name="fineness", unit="log2")
    """Segments of a table per octave."""

    @cached_property
    def trial_octaves(self):
        """Octaves below the full scale over which the mantissa of |g| is normalised."""
        return (self.trial + self.trial).width - 1 - self.operand

    def all(self) -> list[Q]:
        """Every format, in the order of this file."""
        members = (getattr(self, key) for key in vars(type(self)) if key not in {f.name for f in fields(self)})
        return [q for q in members if isinstance(q, Q) and q.name]


def table(formats: Formats) -> str:
    """Return the format table of the documentation, in Markdown."""
    rows = ["| quantity | format | bits | range | step | unit |", "|---|---|---|---|---|---|"]
    for q in formats.all():
        low, high = q.raw_min * q.lsb, (q.raw_max + 1) * q.lsb
        rows.append(f"| {q.name} | {q} | {q.width} | {low:g} to {high:g} | 2^{-q.frac_bits} | {q.unit} |")
    return "\n".join(rows)
