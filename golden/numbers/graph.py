"""The datapath as data: numbers that record what is done to them instead of doing it.

Running the equations on these gives a graph; the pipeline (`hw.pipeline.pipe`) and the compiled integer model
(`sim.backends.native`) are made from it, so neither repeats an equation.
"""

from dataclasses import dataclass, field
from types import SimpleNamespace

from golden.numbers.qformat import BIT, Q, count, smallest, total, unsigned
from golden.numbers.record import Record

AXES = ("x", "y", "z")
IN_TURN = ("turn",)
"""The one component that there is at a time, where a vector's components come one after the other."""


@dataclass(eq=False, repr=False)
class Node:
    """A number of the datapath (`golden.numbers.qarray`): the operation that makes it, its operands and its format.

    ``kind`` is the name of the operation as in `QArray`, or ``input``, ``const``, ``read`` (a table's word) and
    ``part`` (a field of it); ``detail`` is what the operation needs besides operands.
    """

    graph: "Graph"
    kind: str
    fmt: Q
    operands: tuple["Node", ...]
    detail: object = None
    name: str = ""

    def __repr__(self):  # without the operands: a graph has far more paths than nodes
        return f"<{self.kind} {self.name}>"

    def _number(self, other, beside=None) -> "Node":
        if isinstance(other, Node):
            return other
        return self.graph.const(other, beside.fmt if other == 0 and isinstance(beside, Node) else smallest(other))

    def _make(self, kind, fmt, *operands, detail=None):
        return self.graph.add(kind, fmt, operands, detail)

    def __add__(self, other):
        other = self._number(other)
        return self._make("add", self.fmt + other.fmt, self, other)

    __radd__ = __add__

    def __sub__(self, other):
        other = self._number(other)
        return self._make("sub", self.fmt - other.fmt, self, other)

    def __rsub__(self, other):
        return self._number(other) - self

    def __mul__(self, other):
        return self._make("mul", self.fmt * other.fmt, self, other)

    def __abs__(self):
        return self._make("abs", abs(self.fmt), self)

    def __lt__(self, other):
        return self._make("less", BIT, self, self._number(other))

    @staticmethod
    def total(terms):
        return terms[0]._make("sum", total(x.fmt for x in terms), *terms)

    def select(self, yes, no):
        yes, no = self._number(yes, no), self._number(no, yes)
        return self._make("select", yes.fmt.union(no.fmt), self, yes, no)

    def scale(self, power):
        return self._make("scale", self.fmt.scale(power), self)

    def field(self, low, fmt):
        return self._make("field", fmt, self, detail=low)

    def fault(self, name):
        self.graph.faults.append((name, self))

    @staticmethod
    def lead(vector, most):
        graph = vector[0].graph
        if graph.axes == IN_TURN:
            vector = [graph.gather(vector[0])]
        return vector[0]._make("lead", count(most), *vector, detail=most)

    def to(self, fmt, *, left=None, right=None, cut=False):
        if right is not None:
            return self._make("shift_right", fmt, self, right, detail="cut" if cut else None)
        x = self if left is None else self._make("shift_left", self.fmt, self, left)
        return x._make("round", fmt, x)


@dataclass
class Graph:
    """Nodes in an order in which each comes after its operands.

    Attributes
    ----------
    inputs, outputs : dict of str to Node
    faults : list of (str, Node)
        Bits that report a fault of that name, besides the saturation of every ``round`` and ``shift_right`` to a
        format with a name.
    axes : tuple of str
        What the names of a vector's components end in: `AXES`, or `IN_TURN` where they come one after the other.
    """

    nodes: list[Node] = field(default_factory=list)
    inputs: dict[str, Node] = field(default_factory=dict)
    outputs: dict[str, Node] = field(default_factory=dict)
    faults: list[tuple[str, Node]] = field(default_factory=list)
    axes: tuple[str, ...] = AXES

    def add(self, kind, fmt, operands=(), detail=None, name="") -> Node:
        node = Node(self, kind, fmt, tuple(operands), detail, name)
        self.nodes.append(node)
        return node

    def const(self, raw: int, fmt: Q) -> Node:
        return self.add("const", fmt, detail=raw)

    def input(self, name: str, fmt: Q) -> Node:
        self.inputs[name] = node = self.add("input", fmt, name=name)
        return node

    def record(self, prefix: str, formats: dict[str, Q]) -> SimpleNamespace:
        return SimpleNamespace(**{name: self.input(f"{prefix}_{name}", q) for name, q in formats.items()})

    def vector(self, name: str, fmt: Q) -> list[Node]:
        return [self.input(f"{name}_{axis}", fmt) for axis in self.axes]

    def gather(self, x: Node) -> Node:
        """The bits that the sizes of all components have between them, for a component that comes in its turn."""
        size = unsigned(x.fmt.int_bits - x.fmt.signed, x.fmt.frac_bits)
        return self.add("gather", size, (x, self.inputs["first_turn"]))

    def read(self, table: str, word: Record, *index: Node) -> SimpleNamespace:
        """The word of ``table`` at ``index``, as a namespace of its fields."""
        whole = self.add("read", unsigned(word.width, 0), index, detail=(table, word))
        return SimpleNamespace(**{name: self.add("part", q, (whole,), detail=name) for name, q in word.items()})

    def finish(self, values: dict, outputs: list[str]):
        """Name the nodes after the variables that hold them, and keep what the outputs need.

        ``values`` are a datapath's variables; a list is a vector, whose components get an axis as suffix. A variable
        that is called like an input is its next value.
        """
        for name, value in values.items():
            for label, node in flatten(name, value, self.axes):
                if isinstance(node, Node) and not node.name:
                    node.name = f"{label}_next" if label in self.inputs else label
        self.keep({label: node for name in outputs for label, node in flatten(name, values[name], self.axes)})
        self._name_the_rest()

    def keep(self, outputs: dict[str, Node]):
        """Only what these outputs need, and all inputs and faults."""
        self.outputs = outputs
        needed = {id(node) for node in (*self.outputs.values(), *self.inputs.values())}
        needed |= {id(node) for _, node in self.faults}
        for node in reversed(self.nodes):
            if id(node) in needed:
                needed |= {id(operand) for operand in node.operands}
        self.nodes = [node for node in self.nodes if id(node) in needed]

    def _name_the_rest(self):
        """An operand without a name of its own is called after what it is for: ``rate_mul``, ``rate_add`` ..."""
        purpose = {id(node): node.name for node in self.nodes if node.name}
        taken = set(purpose.values())
        for node in reversed(self.nodes):
            for operand in node.operands:
                if id(operand) in purpose:
                    continue
                purpose[id(operand)] = purpose[id(node)]
                stem = f"{purpose[id(node)]}_{operand.kind}"
                names = (stem, *(f"{stem}{number}" for number in range(2, len(self.nodes))))
                operand.name = next(name for name in names if name not in taken)
                taken.add(operand.name)


def flatten(name, value, axes=AXES):
    if isinstance(value, list):
        return [(f"{name}_{axis}", item) for axis, item in zip(axes, value, strict=False)]
    return [(name, value)]


class Reader:
    """The lookups of `golden.datapath.edge` on graph nodes."""

    def __init__(self, graph: Graph, inverse: Record, damper: Record):
        self._graph, self._inverse, self._damper = graph, inverse, damper

    def inverse(self, index):
        return self._graph.read("inverse", self._inverse, index)

    def damper(self, table, index):
        return self._graph.read("damper", self._damper, table, index)
