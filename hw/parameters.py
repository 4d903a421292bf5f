"""The parameters of a circuit: its sizes, the widths of its words, the registers that its device needs."""

from dataclasses import dataclass, field, make_dataclass

from amaranth.hdl import Const, Value

from golden.datapath.formats import Formats
from hw.families.registry import get_family
from hw.pipeline.cost import Cost
from hw.sizes import EDGE, NODE, SIZES, cycles_per_node, sizes_of

Sizes = make_dataclass("Sizes", [(size.name, int, size.default) for size in SIZES.values()], frozen=True)


@dataclass(frozen=True)
class Parameters(Sizes):
    """The parameters of a circuit.

    Parameters
    ----------
    <size> : int
        Each of `hw.sizes.SIZES`, which says what it may be.
    formats : Formats
    cost : Cost, optional
        That of the family unless another is given.
    family : str
        The family of devices whose hard blocks the circuit is made of, a folder of `hw.families`. It computes the same
        with any, and in the same cycles for the same cost.

    Raises
    ------
    ValueError
        If a size is not allowed; if a state word, in which the host writes everything, is shorter than the longest
        record of `golden.datapath.records`; or if the family is unknown.
    """

    formats: Formats = field(default_factory=Formats)
    cost: Cost | None = None
    family: str = "generic"

    def __post_init__(self):
        for name, value in sizes_of(self).items():
            SIZES[name].check(value)
        family = get_family(self.family)
        if self.cost is None:
            object.__setattr__(self, "cost", family.cost)
        longest = max(EDGE.width, NODE.width)
        if self.formats.state < longest:
            raise ValueError(f"state must be at least {longest} bits, as a list's entry has, not {self.formats.state}")

    @property
    def cycles_per_node(self) -> int:
        """Cycles that an updater takes for a node."""
        return cycles_per_node(self)

    @property
    def rows(self) -> int:
        """Edges that a lane holds."""
        return -(-self.edges // self.lanes)

    @property
    def row_bits(self) -> int:
        return max(1, (self.rows - 1).bit_length())

    @property
    def node_bits(self) -> int:
        return (self.nodes - 1).bit_length()

    @property
    def node_rows(self) -> int:
        """Nodes that an updater holds."""
        return -(-self.nodes // self.updates)

    @property
    def node_row_bits(self) -> int:
        return max(1, (self.node_rows - 1).bit_length())

    def node_address(self, node: Value) -> tuple[Value, Value]:
        """Return `node_address` of a node for this number of updaters."""
        return node_address(node, self.updates)

    @property
    def material_bits(self) -> int:
        return max(1, (self.materials - 1).bit_length())

    @property
    def index_bits(self) -> int:
        """Bits of a host address's index, for the deepest memory."""
        table = self.tables << self.formats.damper_index.width
        return (max(self.rows, self.nodes, self.materials, table) - 1).bit_length()


def node_address(node: Value, updates: int) -> tuple[Value, Value]:
    """Return (row, column) of a node, from its number: updater ``column`` holds it at address ``row``."""
    bits = updates.bit_length() - 1
    return (node[bits:], node[:bits]) if bits else (node, Const(0, 1))
