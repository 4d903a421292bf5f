"""When each operation of a datapath's graph (`golden.numbers.graph`) is done: latency follows from what operations
cost."""

from golden.numbers.graph import Graph, Node
from hw.pipeline.cost import Cost
from hw.pipeline.operations import step_count

WIRES = {"scale", "field", "part"}
"""Operations that are only another reading of the same bits."""

CARRIES = {"add", "sub", "sum", "less"}
"""Operations that are a carry chain."""

GREEDY = ("shift_right", "round", "shift_left", "select", "mul")
"""Operations that are the better for one register more, those with the longest way first. A product has it before its
multiplier, whose place is given."""


class Schedule:
    """The cycle of every node of a graph: as early as its operands allow, or, where none of them comes with the item
    itself, as late as its users allow. Where results are waited for in any case, an operation gets a register more.

    A cycle is counted from the one in which the pipeline takes its inputs, so that the latency of an output is its
    cycle: ``cycle[node]``.

    Parameters
    ----------
    graph : Graph
    cost : Cost
    late : set of str
        Inputs that come when they are needed, in cycle ``arrival[name]``: whoever provides them reads a memory then,
        instead of this pipeline carrying the word along.
    static : set of str
        Inputs that do not change while the pipeline works.
    prompt : set of str
        Outputs that are waited for, if not all of them: the last of these comes as early as it can.
    patience : int
        Cycles that the other outputs may come after them, if they gain registers by it.

    Attributes
    ----------
    latency : int
        Cycles from an item's inputs to the last of its results.

    Raises
    ------
    ValueError
        If a late input is needed before it may come.
    """

    def __init__(self, graph: Graph, cost: Cost, *, late=frozenset(), static=frozenset(), prompt=None, patience=0):
        self.graph, self.cost, self._late, self._static = graph, cost, late, static
        self._more: set[Node] = set()
        self._place()
        self._spread(prompt or set(graph.outputs), patience)
        self.latency = max(cycle for cycle in self.cycle.values() if cycle is not None)
        untimed = {"const", "input", *WIRES}
        self._idle = [node for node in graph.nodes if self.cycle[node] is None and node.kind not in untimed]
        self._spread_idle()
        for name, cycle in self.arrival.items():
            if cycle < 0:
                raise ValueError(f"{name} must be needed after its item has come, not {-cycle} cycles before")

    def known(self, node: Node, cycle: int) -> bool:
        """Whether a node has its value in a cycle, or has had it before."""
        if node.kind in WIRES:
            return self.known(node.operands[0], cycle)
        if node.kind == "const" or (node.kind == "input" and node.name in self._static):
            return True
        first = self.arrival.get(node.name, self.cycle[node]) if node.kind == "input" else self.cycle[node]
        return first <= cycle

    def stages(self) -> list[tuple[str, str, int, int]]:
        """(name, operation, first cycle, cycle of the result) of each operation that takes time."""
        return [(n.name, n.kind, self.start[n], self.cycle[n]) for n in self.graph.nodes if n in self.start]

    def _cycles(self, node: Node) -> int:
        return self.cost.of(node) + (node in self._more and node.kind != "mul")

    def _waits(self, operand: Node, user: Node) -> int:
        """Cycles that an operand waits in a register for its user: one for a product with time, and one where a number
        that has just been rounded is to be added, compared or rounded once more, so that two carry chains are not in
        one cycle."""
        if user.kind == "mul":
            return int(user in self._more)
        operand = behind_wires(operand)
        return int(rounds(operand) and not self._cycles(operand) and (user.kind in CARRIES or rounds(user)))

    def _place(self):
        """As early as can be. None where no operand comes with the item."""
        self.cycle: dict[Node, int | None] = {}
        self.start: dict[Node, int] = {}
        for node in self.graph.nodes:
            self.cycle[node] = self._earliest(node)

    def _earliest(self, node: Node) -> int | None:
        if node.kind == "const" or (node.kind == "input" and node.name in self._static | self._late):
            return None
        if node.kind == "input":
            return 0
        ready = [
            self.cycle[operand] + self._waits(operand, node)
            for operand in node.operands
            if self.cycle[operand] is not None
        ]
        if not ready or node.kind in WIRES:
            return max(ready, default=None)
        self.start[node] = max(ready)
        return self.start[node] + self._cycles(node)

    def _spread(self, prompt: set[str], patience: int):
        """A register more for whoever gains by it and has the time."""
        last = max((self.cycle[self.graph.outputs[name]] or 0 for name in prompt), default=0)
        due = {node: last + (name not in prompt) * patience for name, node in self.graph.outputs.items()}
        timed = [node for node in self.graph.nodes if node in self.start]
        latest = self._latest(due)
        for kind in GREEDY:
            for node in timed:
                if node.kind == kind and (kind != "round" or rounds(node)) and latest[node] > self.cycle[node]:
                    self._more.add(node)
                    self._place()
                    latest = self._latest(due)

    def _latest(self, due: dict[Node, int]) -> dict[Node, int]:
        """The last cycle in which each node's value is still in time."""
        latest = dict.fromkeys(self.graph.nodes, max(due.values(), default=0)) | due
        for user in reversed(self.graph.nodes):
            for operand in user.operands:
                cycles = 0 if user.kind in WIRES else self._cycles(user) + self._waits(operand, user)
                latest[operand] = min(latest[operand], latest[user] - cycles)
        return latest

    def _spread_idle(self):
        """Operations on nothing but late inputs have time for registers, as long as none is needed too early."""
        candidates = [node for node in self._idle if rounds(node)] + [n for n in self._idle if n.kind == "select"]
        self._place_idle()
        for node in candidates:
            self._more.add(node)
            self._place_idle()
            if min(self.arrival.values()) < 0:
                self._more.remove(node)
        self._place_idle()

    def _place_idle(self):
        """When the first of its users takes a node, directly or through wires; at the latest in the last cycle. There
        is time for a register behind each of an operation's steps."""
        needed, idle = dict.fromkeys(self.graph.nodes, self.latency), set(self._idle)
        for user in reversed(self.graph.nodes):
            if user in idle:
                steps = step_count(user)
                self.cycle[user] = needed[user]
                self.start[user] = needed[user] - max(self._cycles(user), steps if steps > 1 else 0)
            for operand in user.operands:
                taken = needed[user] if user.kind in WIRES else self.start[user] - self._waits(operand, user)
                needed[operand] = min(needed[operand], taken)
        self.arrival = {name: needed[self.graph.inputs[name]] for name in sorted(self._late)}


def rounds(node: Node) -> bool:
    """Whether it needs a carry chain: where no bits are dropped, nothing is rounded."""
    return node.kind == "round" and node.operands[0].fmt.frac_bits > node.fmt.frac_bits


def behind_wires(node: Node) -> Node:
    """The operation whose bits a node is."""
    return behind_wires(node.operands[0]) if node.kind in WIRES else node
