"""The schedule of a datapath's graph (`golden.numbers.graph`): the cycle of each operation.

No latency is typed anywhere: it follows from what the operations cost (`hw.pipeline.cost`).
"""

from golden.numbers.graph import Graph, Operation
from hw.pipeline.cost import Cost
from hw.pipeline.operations import step_count

WIRES = {"scale", "field", "part"}
"""Kinds that only read the same bits in another format."""

CARRIES = {"add", "sub", "sum", "less"}
"""Kinds that are a carry chain."""

EXTRA_REGISTER_KINDS = ("shift_right", "round", "shift_left", "select", "mul")
"""Kinds that get an extra register where there is slack, slowest first. A product gets it before its multiplier: DSPs
sit at fixed sites, so a register on the route to one helps timing."""


class Schedule:
    """The cycle of every operation of a graph, counted from the cycle in which the pipeline takes its inputs.

    An operation is done as early as its operands allow. If it depends on late and static inputs only, it is done as
    late as its users allow. Operations off the critical path get an extra register each.

    Parameters
    ----------
    graph : Graph
    cost : Cost
    late : set of str
        Inputs that arrive when they are needed, in cycle ``arrival[name]``: they are read from a memory then, so the
        pipeline need not carry them along.
    static : set of str
        Inputs that do not change while the pipeline works.
    critical_outputs : set of str
        Outputs that must come as early as they can, or rather the last of them; by default all outputs.
    slack : int
        Cycles by which the other outputs may come later than the critical ones.

    Attributes
    ----------
    start, cycle : dict of Operation to int
        The cycles in which an operation takes its operands and in which its value is there. The cycle of an output is
        its latency.
    arrival : dict of str to int
        The cycle of each late input.
    latency : int
        Cycles from an item's inputs to the last of its results.

    Raises
    ------
    ValueError
        If a late input is needed before it can arrive.
    """

    def __init__(
        self, graph: Graph, cost: Cost, *, late=frozenset(), static=frozenset(), critical_outputs=None, slack=0
    ):
        self.graph, self.cost, self._late, self._static = graph, cost, late, static
        self._extra: set[Operation] = set()
        self.cycle, self.start = self._as_early_as_possible()
        self._use_slack(critical_outputs or set(graph.outputs), slack)
        self.latency = max(cycle for cycle in self.cycle.values() if cycle is not None)
        untimed = {"const", "input", *WIRES}
        self._idle = [x for x in graph.operations if self.cycle[x] is None and x.kind not in untimed]
        self.arrival = self._use_idle_time()
        for name, cycle in self.arrival.items():
            if cycle < 0:
                raise ValueError(f"{name} must be needed after its item has come, not {-cycle} cycles before")

    def known(self, operation: Operation, cycle: int) -> bool:
        """Return whether an operation's value is there in a cycle, or has been before."""
        if operation.kind in WIRES:
            return self.known(operation.operands[0], cycle)
        if operation.kind == "const" or (operation.kind == "input" and operation.name in self._static):
            return True
        first = self.cycle[operation]
        if operation.kind == "input":
            first = self.arrival.get(operation.name, first)
        return first <= cycle

    def stages(self) -> list[tuple[str, str, int, int]]:
        """Return (name, kind, first cycle, cycle of the result) of each operation that takes time."""
        return [(x.name, x.kind, self.start[x], self.cycle[x]) for x in self.graph.operations if x in self.start]

    def _cycles(self, operation: Operation) -> int:
        return self.cost.of(operation) + (operation in self._extra and operation.kind != "mul")

    def _operand_delay(self, operand: Operation, user: Operation) -> int:
        """Return the cycles that an operand waits in a register for its user.

        It waits for a product with an extra register. It waits if it has just been rounded and is then added, compared
        or rounded again: that would be two carry chains in one cycle.
        """
        if user.kind == "mul":
            return int(user in self._extra)
        operand = before_wires(operand)
        return int(rounds(operand) and not self._cycles(operand) and (user.kind in CARRIES or rounds(user)))

    def _as_early_as_possible(self) -> tuple[dict, dict]:
        """Return (cycle, start). The cycle is None where no operand comes with the item."""
        cycle: dict[Operation, int | None] = {}
        start: dict[Operation, int] = {}
        for operation in self.graph.operations:
            ready = [cycle[x] + self._operand_delay(x, operation) for x in operation.operands if cycle[x] is not None]
            if operation.kind == "input":
                cycle[operation] = None if operation.name in self._static | self._late else 0
            elif not ready or operation.kind in WIRES:
                cycle[operation] = max(ready, default=None)
            else:
                start[operation] = max(ready)
                cycle[operation] = start[operation] + self._cycles(operation)
        return cycle, start

    def _use_slack(self, critical_outputs: set[str], slack: int):
        """Give an extra register to operations whose values are not needed at once."""
        last = max((self.cycle[self.graph.outputs[name]] or 0 for name in critical_outputs), default=0)
        due = {x: last + (name not in critical_outputs) * slack for name, x in self.graph.outputs.items()}
        timed = [x for x in self.graph.operations if x in self.start]
        latest = self._latest(due)
        for kind in EXTRA_REGISTER_KINDS:
            for operation in timed:
                takes_time = operation.kind == kind and (kind != "round" or rounds(operation))
                if takes_time and latest[operation] > self.cycle[operation]:
                    self._extra.add(operation)
                    self.cycle, self.start = self._as_early_as_possible()
                    latest = self._latest(due)

    def _latest(self, due: dict[Operation, int]) -> dict[Operation, int]:
        """Return the last cycle in which each operation's value is still in time."""
        latest = dict.fromkeys(self.graph.operations, max(due.values(), default=0)) | due
        for user in reversed(self.graph.operations):
            for operand in user.operands:
                cycles = 0 if user.kind in WIRES else self._cycles(user) + self._operand_delay(operand, user)
                latest[operand] = min(latest[operand], latest[user] - cycles)
        return latest

    def _use_idle_time(self) -> dict[str, int]:
        """Give an extra register to operations on late inputs only, unless an input would be needed too early. Return
        the arrival of each late input."""
        candidates = [x for x in self._idle if rounds(x)] + [x for x in self._idle if x.kind == "select"]
        arrival = self._as_late_as_possible()
        for operation in candidates:
            self._extra.add(operation)
            arrival = self._as_late_as_possible()
            if min(arrival.values()) < 0:
                self._extra.remove(operation)
        return self._as_late_as_possible()

    def _as_late_as_possible(self) -> dict[str, int]:
        """Place the idle operations just before their first users, at the latest in the last cycle, with a register
        after each of their steps. Return the arrival of each late input."""
        needed, idle = dict.fromkeys(self.graph.operations, self.latency), set(self._idle)
        for user in reversed(self.graph.operations):
            if user in idle:
                steps = step_count(user)
                self.cycle[user] = needed[user]
                self.start[user] = needed[user] - max(self._cycles(user), steps if steps > 1 else 0)
            for operand in user.operands:
                taken = needed[user] if user.kind in WIRES else self.start[user] - self._operand_delay(operand, user)
                needed[operand] = min(needed[operand], taken)
        return {name: needed[self.graph.inputs[name]] for name in sorted(self._late)}


def rounds(operation: Operation) -> bool:
    """Return whether a rounding needs a carry chain: it does not if no bits are dropped."""
    return operation.kind == "round" and operation.operands[0].fmt.frac_bits > operation.fmt.frac_bits


def before_wires(operation: Operation) -> Operation:
    """Return the operation whose bits this one reads."""
    return before_wires(operation.operands[0]) if operation.kind in WIRES else operation
