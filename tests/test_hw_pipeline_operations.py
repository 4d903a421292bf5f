"""Every operation of the datapath as hardware gives the integers and the faults of `golden.numbers.qarray`."""

from collections import Counter
from contextlib import suppress

import numpy as np
import pytest
from amaranth.hdl import Signal
from hw_objects import Piped, simulate, stream
from integer_objects import random_raw

from golden.numbers.block import normalise
from golden.numbers.graph import Graph, Operation
from golden.numbers.qarray import QArray
from golden.numbers.qformat import BIT, Q, unsigned
from hw.pipeline import pipe
from hw.pipeline.cost import Cost
from hw.pipeline.operations import STEPS, shape, shift_count, step_count

COSTS = {
    "registers as usual": Cost(),
    "as few as can be": Cost(
        add=0, sub=0, mul=2, abs=0, less=0, select=0, lead=0, shift_left=0, round=0, shift_right=0
    ),
    "one each": Cost(lead=1, shift_right=1, select=1),
    "more than steps": Cost(add=2, sub=2, mul=5, abs=2, less=2, select=2, lead=4, shift_left=2, round=2, shift_right=5),
}
S, U, SMALL, FINE = Q(2, 16), unsigned(0, 18), Q(3, 2), unsigned(-3, 17)
WIDE, COUNT, SHIFT = Q(4, 33), unsigned(4, 0), Q(8, 0)


def to(fmt, **kwargs):
    return lambda x: {"out": x.to(Q(*fmt, name="narrow", **kwargs))}


def right(fmt, cut=False, **kwargs):
    return lambda x, n: {"out": x.to(Q(*fmt, name="narrow", **kwargs), right=n, cut=cut)}


def normalised(operand):
    def operation(*vector):
        mantissas, shift = normalise(list(vector), operand)
        return {"out": mantissas, "shift": shift}

    return operation


def reported(x, y):
    bit = x < y
    bit.fault("out of order")
    return {"out": bit}


OPERATIONS = {
    "add": ([S, U], lambda x, y: {"out": x + y}),
    "add, other points": ([SMALL, FINE], lambda x, y: {"out": x + y}),
    "add an integer": ([S], lambda x: {"out": x + 3}),
    "sub": ([S, U], lambda x, y: {"out": x - y}),
    "sub, unsigned": ([U, FINE], lambda x, y: {"out": x - y}),
    "sub from an integer": ([U], lambda x: {"out": 1 - x}),
    "mul, signed": ([S, SMALL], lambda x, y: {"out": x * y}),
    "mul, unsigned": ([U, FINE], lambda x, y: {"out": x * y}),
    "mul, signed and unsigned": ([S, U], lambda x, y: {"out": x * y}),
    "mul, unsigned and signed": ([U, S], lambda x, y: {"out": x * y}),
    "abs": ([S], lambda x: {"out": abs(x)}),
    "abs, unsigned": ([U], lambda x: {"out": abs(x)}),
    "less": ([S, FINE], lambda x, y: {"out": x < y}),
    "less than an integer": ([S], lambda x: {"out": x < 0}),
    "select": ([BIT, S, FINE], lambda b, x, y: {"out": b.select(x, y)}),
    "select 0": ([BIT, S], lambda b, x: {"out": b.select(0, x)}),
    "scale": ([S, U], lambda x, y: {"out": x.scale(3) + y.scale(-2)}),
    "field": ([U], lambda x: {"out": x.field(5, unsigned(1, 6)) + 0}),
    "field with a sign": ([S], lambda x: {"out": x.field(2, Q(1, x.fmt.width - 3)) + 0}),
    "lead of one": ([WIDE], normalised(18)),
    "lead of a vector": ([WIDE, WIDE, WIDE], normalised(18)),
    "lead, unsigned": ([unsigned(0, 23)], normalised(12)),
    "lead, by one at most": ([Q(1, 18)], normalised(18)),
    "round": ([S], to((2, 7))),
    "round, saturate": ([S], to((1, 7))),
    "round to unsigned": ([S], to((1, 7), signed=False)),
    "round unsigned": ([U], to((0, 10), signed=False)),
    "round unsigned to signed": ([U], to((0, 10))),
    "round to nothing but the sign": ([S], to((1, 0))),
    "saturate": ([S], to((0, 16))),
    "grow": ([S], to((4, 20))),
    "grow, saturate": ([S], to((1, 20))),
    "round without a fault": ([S], lambda x: {"out": x.to(Q(0, 7))}),
    "shift right": ([WIDE, SHIFT], right((2, 16))),
    "shift right, short": ([S, COUNT], right((2, 12))),
    "shift right, to a finer format": ([S, SHIFT], right((2, 20))),
    "shift right, to a much coarser format": ([WIDE, SHIFT], right((4, 2))),
    "shift right, unsigned": ([U, SHIFT], right((0, 12), signed=False)),
    "shift right, signed to unsigned": ([S, SHIFT], right((1, 12), signed=False)),
    "shift right, unsigned to signed": ([U, SHIFT], right((-1, 12))),
    "shift right and cut": ([WIDE, SHIFT], right((2, 16), cut=True)),
    "shift right and cut, to a finer format": ([S, SHIFT], right((2, 20), cut=True)),
    "shift right and cut, unsigned": ([U, SHIFT], right((0, 12), cut=True, signed=False)),
    "shift right without a fault": ([S, SHIFT], lambda x, n: {"out": x.to(Q(1, 12), right=n)}),
    "a bit that is a fault": ([S, U], reported),
    "one after the other": (
        [S, U, SHIFT],
        lambda x, y, n: {"out": ((x * y).to(Q(1, 17, name="product"), right=n) + x).to(Q(1, 12, name="sum"))},
    ),
}


def operand_values(rng, q, count):
    values = random_raw(rng, q, count)
    if q == SHIFT:  # most of them around what leaves something
        values = np.where(rng.random(count) < 0.8, rng.integers(-3, 45, count), values)
    return values


def flat(outputs):
    for name, value in outputs.items():
        if isinstance(value, list):
            yield from ((f"{name}_{axis}", item) for axis, item in zip("xyz", value, strict=False))
        else:
            yield name, value


def graph_of(operation, formats) -> Graph:
    graph = Graph()
    inputs = [graph.input(f"in{number}", q) for number, q in enumerate(formats)]
    outputs = operation(*inputs)
    graph.name_and_prune(outputs, list(outputs))
    assert all(isinstance(x, Operation) for x in graph.outputs.values())
    return graph


@pytest.mark.parametrize("cost", COSTS)
@pytest.mark.parametrize("name", OPERATIONS)
def test_same_integers_same_faults(name, cost, rng):
    formats, operation = OPERATIONS[name]
    values = [operand_values(rng, q, 400) for q in formats]
    faults = Counter()
    numbers = [QArray(raw, q, faults) for raw, q in zip(values, formats, strict=True)]
    expected = dict(flat(operation(*numbers)))

    dut = Piped(graph_of(operation, formats), COSTS[cost])
    got = stream(dut, {f"in{n}": raw for n, raw in enumerate(values)}, list(expected))
    for label, number in expected.items():
        assert got[label] == number.raw.tolist(), label
    assert got["faults"] == faults


def test_the_operands_reach_every_fault(rng):
    """The test above sees saturation at both ends, and shifts to the left."""
    for name, (formats, operation) in OPERATIONS.items():
        faults = Counter()
        values = [operand_values(rng, q, 400) for q in formats]
        operation(*(QArray(raw, q, faults) for raw, q in zip(values, formats, strict=True)))
        if "saturate" in name or ("shift" in name and "without" not in name and "short" not in name):
            assert faults["narrow"] > 10, name


@pytest.mark.parametrize("cost", COSTS)
def test_only_valid_items_report_faults(cost, rng):
    formats, operation = OPERATIONS["one after the other"]
    values = [operand_values(rng, q, 300) for q in formats]
    faults = Counter()
    expected = operation(*(QArray(raw, q, faults) for raw, q in zip(values, formats, strict=True)))["out"]
    assert faults["product"] > 20 and faults["sum"] > 20
    dut = Piped(graph_of(operation, formats), COSTS[cost])
    got = stream(dut, {f"in{n}": raw for n, raw in enumerate(values)}, ["out"], gaps=rng.integers(0, 3, 300))
    assert got["out"] == expected.raw.tolist()
    assert got["faults"] == faults


@pytest.mark.parametrize("source", [Q(1, 4), unsigned(1, 4), Q(-1, 5), unsigned(3, 2)], ids=str)
@pytest.mark.parametrize("target", [Q(1, 2), unsigned(0, 3), Q(2, 0), unsigned(1, 5)], ids=str)
def test_rounding_and_shifting_exhaustively_at_small_widths(source, target):
    target = Q(target.int_bits, target.frac_bits, target.signed, name="narrow")
    count = Q(4, 0)
    raw, shift = (
        grid.ravel()
        for grid in np.meshgrid(
            np.arange(source.raw_min, source.raw_max + 1), np.arange(count.raw_min, count.raw_max + 1)
        )
    )
    faults = Counter()
    x, n = QArray(raw, source, faults), QArray(shift, count, faults)

    def all_of(x, n):
        return {"rounded": x.to(target), "shifted": x.to(target, right=n), "cut": x.to(target, right=n, cut=True)}

    expected = all_of(x, n)

    graph = Graph()
    a, b = graph.input("a", source), graph.input("b", count)
    graph.name_and_prune(all_of(a, b), list(expected))
    dut = Piped(graph, Cost())
    got = stream(dut, {"a": raw, "b": shift}, list(expected))
    for label, number in expected.items():
        assert got[label] == number.raw.tolist(), label


class NoWires:
    """Signals for the values of an operation that is not built."""

    def __call__(self, value):
        return Signal(value.shape())

    def shifted(self, x, times, places, *, left):
        return Signal(x.shape())


SUMS = {f"sum of {terms}": ([S] * terms, lambda *x: {"out": x[0].total(x)}) for terms in (1, 2, 3, 4, 9, 10)}


@pytest.mark.parametrize("name", [*OPERATIONS, *SUMS])
def test_the_number_of_steps_is_how_often_a_function_yields(name):
    formats, operation = (OPERATIONS | SUMS)[name]
    for x in graph_of(operation, formats).operations:
        if x.kind in STEPS:
            operands = [Signal(shape(operand.fmt)) for operand in x.operands]
            if x.kind == "shift_right":
                operands[1] = shift_count(x, operands[1])
            steps = STEPS[x.kind](NoWires(), x, *operands)
            values, count = next(steps), 1
            with suppress(StopIteration):
                while True:
                    values, count = steps.send(values), count + 1
            assert count == step_count(x)


@pytest.mark.parametrize("cycles", [0, 1, 3])
def test_the_latency_of_a_fault_drives_its_registers(cycles, monkeypatch, rng):
    monkeypatch.setattr(pipe, "FAULT_LATENCY", cycles)
    formats, operation = OPERATIONS["round, saturate"]
    dut = Piped(graph_of(operation, formats), Cost())
    latency, seen = dut.latency, []

    async def bench(ctx):
        for cycle in range(10):
            ctx.set(dut.valid, cycle == 2)
            ctx.set(dut.in0, formats[0].raw_max)
            seen.append(ctx.get(dut.fault))
            await ctx.tick()

    simulate(dut, bench)
    assert seen == [int(cycle == 2 + latency + cycles) for cycle in range(10)]
