"""The datapath as data: numbers that record the operations on them instead of computing.

Running the equations on these gives a graph. The pipeline (`hw.pipeline.pipe`) and the compiled integer model
(`sim.backends.native`) are made from it, so neither repeats an equation.
"""

from dataclasses import dataclass, field
from types import SimpleNamespace

from golden.numbers.qformat import BIT, Q, count, smallest, total, unsigned
from golden.numbers.record import Record

AXES = ("x", "y", "z")
SERIAL_AXIS = ("axis",)
"""The axes of a graph in which the components of a vector come one after the other: it has one component at a time."""


@dataclass(eq=False, repr=False)
class Operation:
    """A `golden.numbers.number.Number` that stands for the operation that makes it.

    Attributes
    ----------
    kind : str
        The name of the operation as in `golden.numbers.qarray.QArray`, or ``input``, ``const``, ``read`` (a table's
        word) or ``part`` (a field of it).
    detail
        What the operation needs besides its operands.
    name : str
        A name that no other operation of the graph has, once `Graph.name_and_prune` has run.
    quantity : str
        The named quantity that this is, or of which it is a component; empty if it is none.
    """

    graph: "Graph"
    kind: str
    fmt: Q
    operands: tuple["Operation", ...]
    detail: object = None
    name: str = ""
    quantity: str = ""

    def __repr__(self):  # without the operands: a graph has far more paths than operations
        return f"<{self.kind} {self.name}>"

    def _number(self, other, beside=None) -> "Operation":
        if isinstance(other, Operation):
            return other
        fmt = beside.fmt if other == 0 and isinstance(beside, Operation) else smallest(other)
        return self.graph.const(other, fmt)

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

    @staticmethod
    def lead(vector, most):
        graph = vector[0].graph
        if graph.axes == SERIAL_AXIS:
            vector = [graph.gather(vector[0])]
        return vector[0]._make("lead", count(most), *vector, detail=most)

    def to(self, fmt, *, left=None, right=None, cut=False):
        if right is not None:
            return self._make("shift_right", fmt, self, right, detail="cut" if cut else None)
        x = self if left is None else self._make("shift_left", self.fmt, self, left)
        return x._make("round", fmt, x)

    def fault(self, name):
        self.graph.faults.append((name, self))


@dataclass
class Graph:
    """Operations, each after its operands.

    Attributes
    ----------
    inputs, outputs : dict of str to Operation
    faults : list of (str, Operation)
        Bits that report a fault of that name, besides the saturation of every ``round`` and ``shift_right`` to a
        format with a name.
    axes : tuple of str
        Suffixes of the names of a vector's components: `AXES` or `SERIAL_AXIS`.
    """

    operations: list[Operation] = field(default_factory=list)
    inputs: dict[str, Operation] = field(default_factory=dict)
    outputs: dict[str, Operation] = field(default_factory=dict)
    faults: list[tuple[str, Operation]] = field(default_factory=list)
    axes: tuple[str, ...] = AXES

    @property
    def fault_names(self) -> list[str]:
        """The names of all faults that the graph can report, sorted."""
        saturating = {x.fmt.name for x in self.operations if x.kind in ("round", "shift_right")}
        return sorted((saturating | {name for name, _ in self.faults}) - {""})

    def add(self, kind, fmt, operands=(), detail=None, name="") -> Operation:
        operation = Operation(self, kind, fmt, tuple(operands), detail, name)
        self.operations.append(operation)
        return operation

    def const(self, raw: int, fmt: Q) -> Operation:
        return self.add("const", fmt, detail=raw)

    def input(self, name: str, fmt: Q) -> Operation:
        self.inputs[name] = operation = self.add("input", fmt, name=name)
        return operation

    def record(self, prefix: str, formats: dict[str, Q]) -> SimpleNamespace:
        return SimpleNamespace(**{name: self.input(f"{prefix}_{name}", q) for name, q in formats.items()})

    def vector(self, name: str, fmt: Q) -> list[Operation]:
        return [self.input(f"{name}_{axis}", fmt) for axis in self.axes]

    def gather(self, x: Operation) -> Operation:
        """Return the OR of the magnitudes of all components, for components that come one after the other."""
        size = unsigned(x.fmt.int_bits - x.fmt.signed, x.fmt.frac_bits)
        return self.add("gather", size, (x, self.inputs["first_axis"]))

    def read(self, table: str, word: Record, *index: Operation) -> SimpleNamespace:
        """Return the word of ``table`` at ``index``, as a namespace of its fields."""
        whole = self.add("read", unsigned(word.width, 0), index, detail=(table, word))
        return SimpleNamespace(**{name: self.add("part", q, (whole,), detail=name) for name, q in word.items()})

    def name_and_prune(self, quantities: dict, outputs: list[str]):
        """Name all operations, and drop what the outputs don't need.

        Parameters
        ----------
        quantities : dict
            Named operations; a list is a vector, whose components get an axis as suffix. A quantity with the name of an
            input is its next value.
        outputs : list of str
            Names of quantities.
        """
        for name, value in quantities.items():
            for label, operation in flatten(name, value, self.axes):
                if not operation.name:
                    operation.name = f"{label}_next" if label in self.inputs else label
                    operation.quantity = name
        self.prune({label: x for name in outputs for label, x in flatten(name, quantities[name], self.axes)})
        self._name_the_rest()

    def prune(self, outputs: dict[str, Operation]):
        """Keep only what these outputs need, and all inputs and faults."""
        self.outputs = outputs
        needed = {id(x) for x in (*self.outputs.values(), *self.inputs.values())} | {id(x) for _, x in self.faults}
        for operation in reversed(self.operations):
            if id(operation) in needed:
                needed |= {id(operand) for operand in operation.operands}
        self.operations = [x for x in self.operations if id(x) in needed]

    def _name_the_rest(self):
        """Name operands that have no name after the quantity they are for: ``rate_mul``, ``rate_add`` ..."""
        purpose = {id(x): x.name for x in self.operations if x.name}
        taken = set(purpose.values())
        for operation in reversed(self.operations):
            for operand in operation.operands:
                if id(operand) in purpose:
                    continue
                purpose[id(operand)] = purpose[id(operation)]
                stem = f"{purpose[id(operation)]}_{operand.kind}"
                names = (stem, *(f"{stem}{number}" for number in range(2, len(self.operations))))
                operand.name = next(name for name in names if name not in taken)
                taken.add(operand.name)


def flatten(name, value, axes=AXES):
    """Return (name, number) pairs: one for a number, one for each component of a vector."""
    if isinstance(value, list):
        return [(f"{name}_{axis}", item) for axis, item in zip(axes, value, strict=False)]
    return [(name, value)]
