"""The edge processor gives the integers of `golden.datapath.edge`, one edge per cycle, in the cycles that its schedule
says."""

from collections import Counter

import numpy as np
import pytest
from datapath_calls import call_edge
from hw_objects import refused, simulate
from integer_objects import random_raw, random_record
from renaming import local_names, renamed
from test_golden_numbers_graph import apply

from golden.datapath import edge, graphs, records
from golden.datapath.formats import Formats
from golden.datapath.rk4 import RK4
from golden.datapath.tables import Tables, inverse_table
from golden.numbers.graph import AXES, Graph, flatten
from golden.numbers.qarray import QArray
from golden.numbers.qformat import Q, unsigned
from hw.emit.verilog import convert
from hw.machine.edge import EdgeDatapath, EdgeProcessor
from hw.machine.interfaces import named
from hw.pipeline.cost import Cost
from hw.pipeline.pipe import FAULT_LATENCY
from hw.pipeline.schedule import WIRES, Schedule

OUTPUTS = ["pull", "base_next", "ratio_next", "total_next"]
TABLES = 2
SHIFT = 7
COSTS = {
    "generic": Cost(),
    "short": Cost(mul=2, shift_right=1, lead=1, select=1),
    "long": Cost(add=2, sub=2, mul=5, abs=2, less=2, select=2, lead=3, shift_left=2, round=2, shift_right=4),
}


def vectors(rng, graph: Graph, count: int) -> dict[str, np.ndarray]:
    """Return raw inputs of so many edges: random and corner values, half of the nodes close together, most shifts
    such that a product does not vanish."""
    formats = {name: node.fmt for name, node in graph.inputs.items()}
    values = {name: random_raw(rng, q, count) for name, q in formats.items()}
    for first, second in ((f"i_{s}_{a}", f"j_{s}_{a}") for s in "xv" for a in AXES):
        q = formats[first]
        near = values[first] + random_raw(rng, Q(1, q.width // 2), count)
        values[second] = np.where(rng.random(count) < 0.5, np.clip(near, q.raw_min, q.raw_max), values[second])
    for name in values:
        if name.startswith("material_") and name.endswith("shift"):
            values[name] = np.where(rng.random(count) < 0.7, rng.integers(-4, 24, count), values[name])
    values["material_table"] = rng.integers(TABLES, size=count)
    stages = [RK4.stage(stage) for stage in rng.integers(RK4.stages, size=count)]
    values |= {f"stage_{bit}": np.array([stage[bit] for stage in stages]) for bit in stages[0]}
    return values | {"velocity_shift": np.full(count, SHIFT)}


def expected(datapath: EdgeDatapath, values, damper, monkeypatch):
    """Return the model's outputs, its faults, and for each operation that faults (cycle, fault's name, items)."""
    fmt, graph = datapath.formats, datapath.graph
    contents = {"inverse": inverse_table(fmt), "damper": damper}
    faults, cycles = Counter(), []
    inputs = {name: QArray(raw, graph.inputs[name].fmt, faults) for name, raw in values.items()}
    results = call_edge(fmt, Tables(fmt, **contents), TABLES, inputs)
    outputs = {label: x.raw.tolist() for name in OUTPUTS for label, x in flatten(name, results[name])}

    numbers = {}
    with monkeypatch.context() as patch:
        patch.setattr(
            QArray,
            "fault",
            lambda bit, name: cycles.append(
                (datapath.schedule.cycle[at], name, np.flatnonzero(np.broadcast_to(bit.raw, len(values["i_x_x"]))))
            ),
        )
        for node in graph.operations:
            at = node
            numbers[node] = apply(node, [numbers[operand] for operand in node.operands], inputs, contents, faults)
        for name, at in graph.faults:
            numbers[at].fault(name)
    return outputs, faults, cycles


def traffic(dut: EdgeProcessor, values, damper, gaps, rng):
    """Return (outputs of each item, cycle in which each entered, (cycle, name) of the reported faults).

    Every wire changes in every cycle and is right only when the schedule asks for it.
    """
    datapath = dut.datapath
    ready = {name: datapath.ready(name) for name in datapath.graph.outputs}
    arrival = {name: datapath.schedule.arrival.get(name, 0) for name in values if name != "velocity_shift"}
    starts = (np.cumsum(gaps) + np.arange(len(gaps))).tolist()
    item_at = {start: item for item, start in enumerate(starts)}
    columns = {name: values[name].tolist() for name in arrival}
    noise = {name: random_raw(rng, datapath.graph.inputs[name].fmt, 64).tolist() for name in arrival}
    outputs, faults = {name: [] for name in ready}, set()

    async def load(ctx):
        formats = records.damper_word(datapath.formats)
        for half, quantity in enumerate(("rho", "sigma")):
            words = formats.starting_with(quantity).pack(damper).ravel()
            ctx.set(dut.table_write, 1 << half)
            for address, word in enumerate(words.tolist()):
                ctx.set(dut.table_address, address)
                ctx.set(dut.table_data, word)
                await ctx.tick()
        ctx.set(dut.table_write, 0)

    async def bench(ctx):
        await load(ctx)
        inputs, results = named(dut.inputs), named(dut.outputs)
        ctx.set(inputs["velocity_shift"], SHIFT)
        for cycle in range(starts[-1] + max(ready.values()) + FAULT_LATENCY + 1):
            ctx.set(dut.valid, cycle in item_at)
            for name, late in arrival.items():
                item = item_at.get(cycle - late)
                ctx.set(inputs[name], noise[name][cycle % 64] if item is None else columns[name][item])
            for name, late in ready.items():
                if cycle - late in item_at:
                    outputs[name].append(ctx.get(results[name]))
            if bits := ctx.get(dut.fault):
                faults.update((cycle, name) for bit, name in enumerate(datapath.faults) if bits >> bit & 1)
            await ctx.tick()

    simulate(dut, bench)
    return outputs, starts, faults


@pytest.mark.parametrize(
    ("fmt", "cost"),
    [
        (Formats(), "generic"),
        (Formats(), "short"),
        (Formats(14, 34), "generic"),
        (Formats(22, 44), "long"),
    ],
    ids=["as built", "fewer registers", "14/34 bits", "22/44 bits, more registers"],
)
def test_the_edge_processor_is_the_model(fmt, cost, rng, monkeypatch):
    """Items come without gaps, then with random ones; outputs and faults come each in its cycle."""
    datapath, count = EdgeDatapath(fmt, TABLES, COSTS[cost]), 240
    damper = random_record(rng, records.damper_word(fmt), (TABLES, 1 << fmt.damper_index.width))
    values = vectors(rng, datapath.graph, count)
    model, counts, cycles = expected(datapath, values, damper, monkeypatch)
    gaps = np.where(np.arange(count) < count // 2, 0, rng.integers(0, 4, count))

    outputs, starts, faults = traffic(EdgeProcessor(datapath), values, damper, gaps, rng)
    for name, raw in model.items():
        assert outputs[name] == raw, name
    assert faults == {(starts[item] + cycle + FAULT_LATENCY, name) for cycle, name, items in cycles for item in items}
    assert counts == {name: sum(len(items) for _, other, items in cycles if other == name) for name in counts}
    assert len(counts) >= 6 and all(len(set(raw)) > count / 16 for raw in model.values())


SCHEDULES = {name: EdgeDatapath(Formats(), TABLES, cost).schedule for name, cost in COSTS.items()}


@pytest.mark.parametrize("name", SCHEDULES)
def test_no_operation_starts_before_its_operands_are_there(name):
    schedule = SCHEDULES[name]
    there = dict(schedule.cycle)
    for label, cycle in schedule.arrival.items():
        there[schedule.graph.inputs[label]] = cycle
    for node in schedule.graph.operations:  # wires are there with what they are wires of
        if node.kind in WIRES:
            there[node] = there[node.operands[0]]
    for node, start in schedule.start.items():
        assert schedule.cycle[node] >= start + schedule.cost.of(node)
        assert all(there[operand] is None or there[operand] <= start for operand in node.operands), node.name


@pytest.mark.parametrize("name", SCHEDULES)
def test_a_late_input_comes_exactly_when_it_is_needed_first(name):
    schedule = SCHEDULES[name]
    for label, cycle in schedule.arrival.items():
        reading = {schedule.graph.inputs[label]}
        reading |= {n for n in schedule.graph.operations if n.kind in WIRES and n.operands[0] in reading}
        starts = [start for node, start in schedule.start.items() if reading & set(node.operands)]
        assert cycle == min(starts), label


@pytest.mark.parametrize("name", SCHEDULES)
def test_latencies_add_up(name):
    schedule = SCHEDULES[name]
    assert schedule.latency == max(schedule.cycle[node] for node in schedule.graph.outputs.values())
    assert len({schedule.cycle[schedule.graph.outputs[f"pull_{axis}"]] for axis in AXES}) == 1
    stages = schedule.stages()
    assert [stage[:2] for stage in stages] == [
        (n.name, n.kind) for n in schedule.graph.operations if n in schedule.start
    ]
    assert all(0 <= start <= end <= schedule.latency for _, _, start, end in stages)


def test_the_verilog_does_not_depend_on_names_of_variables_in_the_equations(monkeypatch):
    def made():
        datapath = EdgeDatapath(Formats(), TABLES, Cost())
        return datapath.schedule.stages(), convert(EdgeProcessor(datapath), "edge_processor")

    stages, text = made()
    names = local_names(edge)
    assert "stretch" in names
    monkeypatch.setattr(graphs, "edge", renamed(edge, {name: f"renamed_{name}" for name in names})["edge"])
    assert made() == (stages, text)


def test_a_quantity_has_its_extra_register_whatever_its_axis():
    plain, extra = (
        EdgeDatapath(Formats(), TABLES, Cost(extra_register_after=names)).schedule for names in ((), ("dashpot", "w"))
    )
    for schedule, registers in ((plain, 0), (extra, 1)):
        for x in schedule.graph.operations:
            if x.quantity in ("dashpot", "w"):
                assert schedule.cost.of(x) == Cost().shift_right * (x.quantity == "dashpot") + registers


def test_a_misspelt_quantity_is_refused():
    refused(
        lambda: Cost(extra_register_after=("strech",)),
        "extra_register_after must name quantities of golden.datapath.quantities, not 'strech'",
    )


def test_a_schedule_by_hand():
    graph = Graph()
    x, y, late, fixed = (graph.input(name, Q(4, 0)) for name in ("x", "y", "late", "fixed"))
    product = x * y
    total = product + x  # x waits for the product
    result = total - (late + fixed)
    graph.name_and_prune({"product": product, "total": total, "result": result}, ["product", "result"])
    schedule = Schedule(graph, Cost(add=1, sub=2, mul=4), late={"late"}, static={"fixed"})
    ends = {name: end for name, _, _, end in schedule.stages()}
    assert ends == {"product": 4, "total": 5, "result_add": 5, "result": 7}
    assert schedule.arrival == {"late": 4}
    assert schedule.latency == 7


def test_wires_take_no_time():
    graph = Graph()
    x = graph.input("x", unsigned(0, 8))
    graph.name_and_prune({"y": x.field(2, unsigned(0, 4)).scale(3)}, ["y"])
    schedule = Schedule(graph, Cost())
    assert schedule.latency == 0 and schedule.stages() == []


def test_a_multiplier_has_two_registers():
    refused(lambda: Cost(mul=1), "mul must be at least 2 registers, not 1")
