"""The pipeline of a graph (`golden.numbers.graph`): its registers follow from the schedule."""

import itertools

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value

from golden.numbers.graph import Operation
from hw.blocks.gather import Gather
from hw.blocks.multiplier import Multiplier
from hw.blocks.narrow import NarrowMultiplier
from hw.blocks.shifter import ShiftStage
from hw.pipeline.delay import DelayLines
from hw.pipeline.operations import STEPS, field, never, shape, shift_count, size, step_count
from hw.pipeline.schedule import WIRES, Schedule, before_wires

FAULT_LATENCY = 1
"""Registers from a value to its fault."""


class Pipe:
    """The registers and multipliers of a scheduled graph, added to a module; call `build` last.

    Parameters
    ----------
    m : Module
    schedule : Schedule
    inputs : dict of str to Value
        Each in its cycle: 0, or that in ``schedule.arrival``.
    valid : Value
        1 in cycle 0 of an item; without it an item reports no faults.
    tables : dict of str to callable
        ``tables[name](address values)`` gives a table's word ``schedule.cost.read`` cycles later.
    reset : Value, optional
        Clears valid bits and faults, instead of the reset of the clock domain.

    Attributes
    ----------
    faults : dict of str to Value
        1 `FAULT_LATENCY` cycles after a fault of that name.
    """

    def __init__(self, m: Module, schedule: Schedule, inputs, valid, tables=None, reset=None):
        self._m, self._schedule, self._inputs, self._tables = m, schedule, inputs, tables or {}
        self._delays, self._results = DelayLines(m, reset), {}
        self._valid, self._reset = valid, reset
        self._faults: dict[str, list] = {}
        # The terms of a sum come from all over the device, so their multipliers end in a register near the sum
        sums = [operation for operation in schedule.graph.operations if operation.kind == "sum"]
        self._summed = {before_wires(term) for operation in sums for term in operation.operands}
        for operation in schedule.graph.operations:
            if operation in schedule.start:
                self._emit(operation)
        for name, operation in schedule.graph.faults:
            self._report(name, self.at(operation, schedule.cycle[operation]), schedule.cycle[operation])
        self.faults = {name: Cat(*bits).any() for name, bits in self._faults.items()}

    def output(self, name: str, cycle: int | None = None):
        """Return the value of an output in its cycle, or delayed to a later one."""
        operation = self._schedule.graph.outputs[name]
        return self.at(operation, self._schedule.cycle[operation] if cycle is None else cycle)

    def build(self):
        """Make the delay lines, once all outputs have been asked for."""
        self._delays.build()

    def valid(self, cycle: int):
        """Return a bit that is 1 when the item in ``cycle`` is valid."""
        return self._delays.later(self._valid, cycle, name="valid", reset=True)

    def at(self, operation: Operation, cycle: int):
        """Return an operation's value in ``cycle``; delay lines are shared."""
        if operation.kind == "const":
            return Const(operation.detail, shape(operation.fmt))
        if operation.kind in WIRES:
            return field(operation, self.at(operation.operands[0], cycle))
        if operation.kind == "input":
            return self._input(operation, cycle)
        start, done = self._schedule.start[operation], self._schedule.cycle[operation]
        return self._delays.later(self._results[operation], cycle - done, name=operation.name, wire=start == done)

    def _input(self, operation, cycle):
        first = self._schedule.cycle[operation]
        if first is None:  # late, or static and then the same in every cycle
            first = self._schedule.arrival.get(operation.name, cycle)
        return self._delays.later(self._inputs[operation.name], cycle - first)

    def _emit(self, operation: Operation):
        start, done = self._schedule.start[operation], self._schedule.cycle[operation]
        operands = [self._operand(operation, number, start) for number in range(len(operation.operands))]
        if operation.kind == "mul":
            result = self._product(operation, operands, done - start)
        elif operation.kind == "read":
            result = self._tables[operation.detail[0]](*operands)
        elif operation.kind == "gather":
            result = self._gathered(operation, *operands)
        else:
            result, *fault = self._steps(operation, operands)
            if fault:
                self._report(operation.fmt.name, fault[0], done)
        self._results[operation] = result

    def _product(self, operation, operands, registers):
        narrow = self._schedule.cost.narrow_product(operation)
        make, (a, b) = (NarrowMultiplier, sorted(operands, key=len)[::-1]) if narrow else (Multiplier, operands)
        how = {} if narrow else {"apart": operation in self._summed}
        self._m.submodules[operation.name] = multiplier = make(a.shape(), b.shape(), registers=registers, **how)
        self._m.d.comb += [multiplier.a.eq(a), multiplier.b.eq(b)]
        return multiplier.product

    def _gathered(self, operation, x, first):
        self._m.submodules[operation.name] = gather = Gather(width=operation.fmt.width)
        self._m.d.comb += [gather.i.eq(size(x)), gather.first.eq(first)]
        return gather.o

    def _operand(self, operation, number, start):
        """Return an operand in the operation's first cycle. The count of a right shift is prepared up to two cycles
        earlier, if it is known then, and registered."""
        if (operation.kind, number) != ("shift_right", 1):
            return self.at(operation.operands[number], start)
        count = operation.operands[1]
        before = next(cycles for cycles in (2, 1, 0) if not cycles or self._schedule.known(count, start - cycles))
        ready = shift_count(operation, self.at(count, start - before))
        if not before:
            return ready
        register = Signal(len(ready), name=f"{operation.name}_count", reset_less=True)
        self._m.d.sync += register.eq(ready)
        return self._delays.later(register, before - 1)

    def _steps(self, operation, operands):
        """Return the operation's values. The registers that it costs follow its last steps."""
        count, cost = step_count(operation), self._schedule.cycle[operation] - self._schedule.start[operation]
        steps = STEPS[operation.kind](_Wires(self._m, operation.name), operation, *operands)
        values = next(steps)
        for step in range(1, count):
            if count - step < cost:
                values = self._register([f"{operation.name}_s{step}_{n}" for n in range(len(values))], values)
            values = steps.send(values)
        if not operation.fmt.name:  # a saturation is no fault
            values = values[:1]
        names = [operation.name, f"{operation.name}_fault"][: len(values)]
        result = Signal(shape(operation.fmt), name=operation.name, reset_less=True)
        self._m.d["sync" if cost else "comb"] += result.eq(values[0])
        rest = self._register(names[1:], values[1:]) if cost else values[1:]
        values = (result, *rest)
        for extra in range(count, cost):
            values = self._register([f"{name}_r{extra}" for name in names], values)
        return values

    def _register(self, names, values):
        registers = []
        for name, value in zip(names, values, strict=True):
            if isinstance(value, Const) or not len(value):
                registers.append(value)
                continue
            registers.append(Signal(value.shape(), name=name, reset_less=True))
            self._m.d.sync += registers[-1].eq(value)
        return tuple(registers)

    def _report(self, name, bit, cycle):
        reports = self._faults.setdefault(name, [])
        if not never(bit):
            label, fault = f"{name.replace(' ', '_')}_reported_{len(reports)}", bit & self.valid(cycle)
            reports.append(self._registered_fault(label, fault))

    def _registered_fault(self, label, fault):
        local = self._reset is not None
        for number in range(FAULT_LATENCY):
            register = Signal(name=f"{label}_d{number}" if number else label, reset_less=local)
            self._m.d.sync += register.eq(Mux(self._reset, 0, fault) if local else fault)
            fault = register
        return fault


class _Wires:
    """Signals and shift stages for the values of an operation (`hw.pipeline.operations`)."""

    def __init__(self, m: Module, name: str):
        self._m, self._name, self._numbers = m, name, itertools.count(1)

    def __call__(self, value) -> Signal:
        signal = Signal(value.shape(), name=f"{self._name}_w{next(self._numbers)}")
        self._m.d.comb += signal.eq(value)
        return signal

    def shifted(self, x, times, places: int, *, left: bool) -> Value:
        stage = ShiftStage(x.shape(), len(times), places, left=left)
        self._m.submodules[f"{self._name}_by_{places}"] = stage
        self._m.d.comb += [stage.i.eq(x), stage.times.eq(times)]
        return stage.o.as_signed() if x.shape().signed else stage.o
