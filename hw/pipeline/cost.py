"""What each operation of the datapath costs in registers, in one place."""

from dataclasses import dataclass

from golden.numbers.graph import Node
from hw.blocks.gather import GATHERED
from hw.blocks.memory import READ_LATENCY
from hw.blocks.narrow import levels
from hw.pipeline.operations import step_count


@dataclass(frozen=True)
class Cost:
    """Registers behind each kind of operation of `golden.numbers.graph` (0: it shares the next operation's cycle).

    Those named in ``more``, as `golden.numbers.graph` names them but for a vector's axis, have one more: place and
    route found the longest ways behind them.

    A product with an unsigned number of at most ``narrow`` bits is made of lookup tables instead of a multiplier, if
    ``mul`` registers are enough for it (`hw.blocks.narrow`).

    An operation in several steps (`hw.pipeline.operations`) gets its registers behind its last steps; those that it has
    more than steps follow as a delay. A sum has them behind each addition of three numbers.

    Raises
    ------
    ValueError
        If a multiplier has fewer than 2.
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
    more: tuple[str, ...] = ("d", "relaxed", "stretch", "spring", "rho", "pull", "acceleration")

    def of(self, node: Node) -> int:
        """Cycles from a node's operands to its value."""
        registers = getattr(self, node.kind)
        vector, _, axis = node.name.rpartition("_")
        more = (vector if axis in node.graph.axes else node.name) in self.more
        return (registers * step_count(node) if node.kind == "sum" else registers) + more

    def narrow_product(self, node: Node) -> bool:
        """Whether a product is made of lookup tables."""
        narrow = min((operand.fmt for operand in node.operands), key=lambda q: q.width)
        return not narrow.signed and narrow.width <= self.narrow and levels(narrow.width) <= self.mul

    def __post_init__(self):
        if self.mul < 2:
            raise ValueError(f"mul must be at least 2 registers, not {self.mul!r}")
