"""The number of registers after each operation of the datapath, in one place."""

from dataclasses import dataclass

from golden.datapath.quantities import QUANTITIES, check_known
from golden.numbers.graph import Operation
from hw.blocks.gather import GATHERED
from hw.blocks.memory import READ_LATENCY
from hw.blocks.narrow import levels
from hw.pipeline.operations import step_count


@dataclass(frozen=True)
class Cost:
    """Registers after each kind of operation; with 0 it shares a cycle with the operation that uses it.

    An operation in several steps (`hw.pipeline.operations`) has its registers after its last steps; if it has more
    registers than steps, the rest follow as a delay.

    Parameters
    ----------
    add, sub, abs, less, select, lead, shift_left, round, shift_right : int
        Registers after an operation of that kind.
    mul : int
        Registers in and after a multiplier, at least 2.
    narrow : int
        Bits up to which an unsigned factor makes a product of lookup tables instead of a multiplier, if ``mul``
        registers are enough for it (`hw.blocks.narrow`).
    sum : int
        Registers after each addition of three terms.
    gather, read : int
        Cycles of `hw.blocks.gather.Gather` and of a block RAM.
    extra_register_after : tuple of str
        Quantities with one register more: their paths were the longest after routing.

    Raises
    ------
    ValueError
        If a multiplier has fewer than 2 registers, or there is no quantity of such a name.
    """

    add: int = 1
    sub: int = 1
    mul: int = 3
    narrow: int = 8
    abs: int = 1
    less: int = 1
    select: int = 0
    sum: int = 1
    gather: int = GATHERED
    lead: int = 2
    shift_left: int = 1
    round: int = 0
    shift_right: int = 2
    read: int = READ_LATENCY
    extra_register_after: tuple[str, ...] = tuple(q.name for q in QUANTITIES.values() if q.extra_register_after)

    def __post_init__(self):
        if self.mul < 2:
            raise ValueError(f"mul must be at least 2 registers, not {self.mul!r}")
        check_known(self.extra_register_after, "extra_register_after")

    def of(self, operation: Operation) -> int:
        """Return the cycles from an operation's operands to its value."""
        registers = getattr(self, operation.kind)
        steps = step_count(operation) if operation.kind == "sum" else 1
        return registers * steps + (operation.quantity in self.extra_register_after)

    def narrow_product(self, operation: Operation) -> bool:
        """Return whether a product is made of lookup tables."""
        narrow = min((operand.fmt for operand in operation.operands), key=lambda q: q.width)
        return not narrow.signed and narrow.width <= self.narrow and levels(narrow.width) <= self.mul
