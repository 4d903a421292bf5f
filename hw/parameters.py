"""The parameters of a circuit: how much it holds, how wide its words are, what its device's registers cost."""

from dataclasses import dataclass, field
from typing import ClassVar

from amaranth.hdl import Const, Value

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.numbers.graph import AXES
from hw.families import FAMILIES
from hw.pipeline.cost import Cost

EDGE, NODE = records.edge_entry(), records.node_entry()


@dataclass(frozen=True)
class Parameters:
    """What a circuit is built for.

    Parameters
    ----------
    lanes : int
        Edge processors, 1 to 8.
    updates : int
        Nodes updated per cycle, 1 or 2: node updaters, each with its share of every memory of nodes.
    axes : int
        Axes of a node that an updater takes per cycle: 3, or 1, with which it is little more than a third as large
        and takes three cycles for a node.
    nodes, edges, materials, tables : int
        Capacity. Each lane holds ``edges / lanes`` edges, rounded up.
    formats : Formats
    cost : Cost
    family : str
        Of devices, a name in `hw.families.FAMILIES`: which hard blocks the circuit is made of. It computes the same in
        the same cycles with any.

    Raises
    ------
    ValueError
        If one of them is out of range: `golden.datapath.records` says how large a node's number may be, and so on; if a
        state word, in which the host writes everything, is shorter than the longest of those records; or if the family
        is unknown.
    """

    lanes: int = 4
    updates: int = 1
    nodes: int = 512
    edges: int = 4096
    materials: int = 16
    tables: int = 4
    axes: int = len(AXES)
    formats: Formats = field(default_factory=Formats)
    cost: Cost = field(default_factory=Cost)
    family: str = "generic"

    RANGES: ClassVar[dict[str, tuple[int, int]]] = {
        "lanes": (1, NODE["mask"].width // 2),
        "updates": (1, 2),
        "nodes": (2, EDGE["i"].raw_max + 1),
        "edges": (1, 1 << 16),  # index bits of a host address
        "materials": (1, EDGE["material"].raw_max + 1),
        "tables": (1, 16),
    }
    SIZES: ClassVar[tuple[str, ...]] = (*RANGES, "axes")

    def __post_init__(self):
        for name, (low, high) in self.RANGES.items():
            value = getattr(self, name)
            if not isinstance(value, int) or not low <= value <= high:
                raise ValueError(f"{name} must be a whole number from {low} to {high}, not {value!r}")
        if not isinstance(self.axes, int) or self.axes not in (1, len(AXES)):
            raise ValueError(f"axes must be 1 or {len(AXES)}, not {self.axes!r}")
        if self.family not in FAMILIES:
            raise ValueError(f"family must be {' or '.join(FAMILIES)}, not {self.family!r}")
        longest = max(EDGE.width, NODE.width)
        if self.formats.state < longest:
            raise ValueError(f"state must be at least {longest} bits, as a list's entry has, not {self.formats.state}")

    @property
    def cycles_per_node(self) -> int:
        """Cycles that an updater takes for a node."""
        return cycles_per_node(self)

    @property
    def rows(self) -> int:
        """Edges a lane holds."""
        return -(-self.edges // self.lanes)

    @property
    def row_bits(self) -> int:
        return max(1, (self.rows - 1).bit_length())

    @property
    def node_bits(self) -> int:
        return (self.nodes - 1).bit_length()

    @property
    def node_rows(self) -> int:
        """Nodes an updater holds."""
        return -(-self.nodes // self.updates)

    @property
    def node_row_bits(self) -> int:
        return max(1, (self.node_rows - 1).bit_length())

    def node_place(self, node):
        return node_place(node, self.updates)

    @property
    def material_bits(self) -> int:
        return max(1, (self.materials - 1).bit_length())

    @property
    def index_bits(self) -> int:
        """Bits of a host address's index, for the deepest memory."""
        table = self.tables << self.formats.damper_index.width
        return (max(self.rows, self.nodes, self.materials, table) - 1).bit_length()


def cycles_per_node(sizes) -> int:
    """Cycles that an updater takes for a node, of `Parameters` or anything with the same sizes."""
    return len(AXES) // sizes.axes


def updated(sizes) -> str:
    """Nodes that are updated per cycle."""
    return str(sizes.updates) if cycles_per_node(sizes) == 1 else f"{sizes.updates}/{cycles_per_node(sizes)}"


def counted(sizes) -> str:
    """All sizes, for a sentence."""
    counts = {name: str(getattr(sizes, name)) for name in Parameters.RANGES} | {"updates": updated(sizes)}
    return ", ".join(f"{n} {name.removesuffix('s') if n == '1' else name}" for name, n in counts.items())


def node_place(node: Value, updates: int) -> tuple[Value, Value]:
    """(row, column) of a node's number: the updater ``column`` holds it as its ``row``."""
    bits = updates.bit_length() - 1
    return (node[bits:], node[:bits]) if bits else (node, Const(0, 1))
