"""The operations that the equations of the datapath need of a number."""

from typing import Protocol, Self, runtime_checkable

from golden.numbers.qformat import Q


@runtime_checkable
class Number(Protocol):
    """A fixed-point number with a format. All operations are exact; only `to` rounds and saturates.

    `golden.numbers.qarray.QArray` computes with integers, `golden.numbers.graph.Operation` records what is computed.
    Comparisons give a bit, a number in the format `golden.numbers.qformat.BIT`. An operand may be an int.
    """

    @property
    def fmt(self) -> Q:
        """The format."""

    def __add__(self, other: Self | int) -> Self: ...

    def __radd__(self, other: int) -> Self: ...

    def __sub__(self, other: Self | int) -> Self: ...

    def __rsub__(self, other: int) -> Self: ...

    def __mul__(self, other: Self) -> Self: ...

    def __abs__(self) -> Self: ...

    def __lt__(self, other: Self | int) -> Self: ...

    @staticmethod
    def total(terms: list["Number"]) -> "Number":
        """Return the sum of all ``terms``."""

    def select(self, yes: Self | int, no: Self | int) -> Self:
        """Return ``yes`` where this bit is 1, ``no`` where it is 0, in the format that holds both."""

    def scale(self, power: int) -> Self:
        """Return this number times ``2**power``: the same integer in another format."""

    def field(self, low: int, fmt: Q) -> Self:
        """Return bits ``low`` and up of the integer, read as ``fmt``."""

    @staticmethod
    def lead(vector: list["Number"], most: int) -> "Number":
        """Return how far left all numbers of ``vector`` can be shifted without loss, at most ``most``."""

    def to(self, fmt: Q, *, left: Self | None = None, right: Self | None = None, cut: bool = False) -> Self:
        """Return this number (times ``2**left``, or ``2**-right``) in the format ``fmt``, rounded half up and then
        saturated. A saturation is reported as a fault named after the format, if that has a name.

        ``left`` is a shift that loses no leading bits, as `lead` counts it. A shift to the right may ``cut`` instead of
        rounding: it then rounds down, which needs no carry.
        """

    def fault(self, name: str) -> None:
        """Report a fault called ``name`` wherever this bit is 1."""
