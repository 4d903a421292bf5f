"""The graphs of the datapath, evaluated operation by operation, give the same bits and faults as the equations."""

import re
from collections import Counter

import numpy as np
import pytest
from datapath_calls import call_edge, call_node
from integer_objects import random_raw, random_record

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.graphs import edge_graph, node_graph
from golden.datapath.rk4 import RK4
from golden.datapath.tables import Tables, inverse_table
from golden.numbers.graph import Graph, flatten
from golden.numbers.qarray import QArray
from golden.numbers.qformat import BIT, Q
from hw.pipeline.cost import Cost

ITEMS = 400
SEGMENTS = 1 << Formats().damper_index.width

# of IEEE 1800, so that the names serve in Verilog and SystemVerilog
KEYWORDS = """
accept_on alias always always_comb always_ff always_latch and assert assign assume automatic before begin bind bins
binsof bit break buf bufif0 bufif1 byte case casex casez cell chandle checker class clocking cmos config const
constraint context continue cover covergroup coverpoint cross deassign default defparam design disable dist do edge
else end endcase endchecker endclass endclocking endconfig endfunction endgenerate endgroup endinterface endmodule
endpackage endprimitive endprogram endproperty endspecify endsequence endtable endtask enum event eventually expect
export extends extern final first_match for force foreach forever fork forkjoin function generate genvar global
highz0 highz1 if iff ifnone ignore_bins illegal_bins implements implies import incdir include initial inout input
inside instance int integer interconnect interface intersect join join_any join_none large let liblist library local
localparam logic longint macromodule matches medium modport module nand negedge nettype new nexttime nmos nor
noshowcancelled not notif0 notif1 null or output package packed parameter pmos posedge primitive priority program
property protected pull0 pull1 pulldown pullup pulsestyle_ondetect pulsestyle_onevent pure rand randc randcase
randsequence rcmos real realtime ref reg reject_on release repeat restrict return rnmos rpmos rtran rtranif0 rtranif1
s_always s_eventually s_nexttime s_until s_until_with scalared sequence shortint shortreal showcancelled signed small
soft solve specify specparam static string strong strong0 strong1 struct super supply0 supply1 sync_accept_on
sync_reject_on table tagged task this throughout time timeprecision timeunit tran tranif0 tranif1 tri tri0 tri1
triand trior trireg type typedef union unique unique0 unsigned until until_with untyped use uwire var vectored
virtual void wait wait_order wand weak weak0 weak1 while wildcard wire with within wor xnor xor
""".split()


def evaluate(graph: Graph, inputs: dict[str, QArray], contents: dict, faults: Counter) -> dict:
    """Return the number of every operation, computed with `QArray`, which must agree on the format."""
    numbers = {}
    for n in graph.operations:
        numbers[n] = apply(n, [numbers[operand] for operand in n.operands], inputs, contents, faults)
        if n.kind != "read":
            assert numbers[n].fmt == n.fmt, n.name
    for name, bit in graph.faults:
        numbers[bit].fault(name)
    return numbers


def apply(n, x, inputs, contents, faults):
    match n.kind:
        case "input":
            return inputs[n.name]
        case "const":
            return QArray(np.int64(n.detail), n.fmt, faults)
        case "add":
            return x[0] + x[1]
        case "sub":
            return x[0] - x[1]
        case "sum":
            return QArray.total(x)
        case "mul":
            return x[0] * x[1]
        case "abs":
            return abs(x[0])
        case "less":
            return x[0] < x[1]
        case "select":
            return x[0].select(x[1], x[2])
        case "scale":
            return x[0].scale(n.fmt.int_bits - x[0].fmt.int_bits)
        case "field":
            return x[0].field(n.detail, n.fmt)
        case "lead":
            return QArray.lead(x, n.detail)
        case "shift_left":
            return QArray(x[0].raw << x[1].raw, n.fmt, faults)
        case "round":
            return x[0].to(n.fmt)
        case "shift_right":
            return x[0].to(n.fmt, right=x[1], cut=n.detail == "cut")
        case "read":
            table, word = n.detail
            raw = {name: contents[table][name][tuple(index.raw for index in x)] for name in word}
            return {name: QArray(raw[name], q, faults) for name, q in word.items()}
        case "part":
            return x[0][n.detail]
    raise AssertionError(n.kind)


def random_inputs(graph, rng, faults, stage):
    values = {name: random_raw(rng, n.fmt, ITEMS) for name, n in graph.inputs.items()}
    values |= {f"stage_{name}": np.int64(bit) for name, bit in RK4.stage(stage).items()}
    values["velocity_shift"] = np.int64(7)
    return {name: QArray(raw, graph.inputs[name].fmt, faults) for name, raw in values.items()}


def assert_equal(graph, numbers, values, outputs):
    expected = {label: x for name in outputs for label, x in flatten(name, values[name])}
    assert graph.outputs.keys() == expected.keys()
    for label, x in expected.items():
        got = numbers[graph.outputs[label]]
        assert got.fmt == x.fmt and np.array_equal(got.raw, np.broadcast_to(x.raw, np.shape(got.raw))), label


@pytest.mark.parametrize("stage", range(4))
@pytest.mark.parametrize("fmt", [Formats(), Formats(14, 32)], ids=["18/36", "14/32"])
def test_the_graph_of_an_edge_computes_the_edge(fmt, stage, rng):
    tables = 3
    graph = edge_graph(fmt, tables)
    faults, faults_of_graph = Counter(), Counter()
    damper = random_record(rng, records.damper_word(fmt), (tables, SEGMENTS))
    contents = {"inverse": inverse_table(fmt), "damper": damper}
    inputs = random_inputs(graph, rng, faults, stage)
    inputs["material_table"].raw[:] = rng.integers(tables, size=ITEMS)

    values = call_edge(fmt, Tables(fmt, **contents), tables, inputs)
    again = {name: QArray(x.raw, x.fmt, faults_of_graph) for name, x in inputs.items()}
    numbers = evaluate(graph, again, contents, faults_of_graph)
    assert_equal(graph, numbers, values, ["pull", "base_next", "ratio_next", "total_next"])
    assert faults == faults_of_graph and len(faults) >= 5


@pytest.mark.parametrize("stage", range(4))
@pytest.mark.parametrize("banks", [1, 2, 5])
def test_the_graph_of_a_node_computes_the_node(banks, stage, rng):
    fmt = Formats()
    graph = node_graph(fmt, banks)
    faults, faults_of_graph = Counter(), Counter()
    inputs = random_inputs(graph, rng, faults, stage)
    values = call_node(fmt, banks, inputs)
    again = {name: QArray(x.raw, x.fmt, faults_of_graph) for name, x in inputs.items()}
    numbers = evaluate(graph, again, {}, faults_of_graph)
    outputs = ["force", "x", "v", "x_base_next", "v_base_next", "x_total", "v_total"]
    assert_equal(graph, numbers, values, outputs)
    assert faults == faults_of_graph and len(faults) >= 3


GRAPHS = {
    "edge": edge_graph(Formats(), 1),
    "edge, 64 tables": edge_graph(Formats(), 64),
    "node": node_graph(Formats(), 1),
    "node, 8 accumulators": node_graph(Formats(), 8),
}


@pytest.mark.parametrize("name", GRAPHS)
def test_every_name_is_a_different_legal_identifier(name):
    names = [n.name for n in GRAPHS[name].operations]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch("[a-z][a-z0-9_]*", word) for word in names)
    assert not set(names) & set(KEYWORDS)


@pytest.mark.parametrize("name", GRAPHS)
def test_operands_come_first_and_nothing_is_without_use(name):
    graph = GRAPHS[name]
    seen = set()
    for n in graph.operations:
        assert seen.issuperset(n.operands), n.name
        seen.add(n)
    used = {operand for n in graph.operations for operand in n.operands}
    used |= {*graph.outputs.values(), *graph.inputs.values(), *(bit for _, bit in graph.faults)}
    assert used == seen


def test_an_edge_takes_as_many_multipliers_as_the_design_says():
    products = [[x.fmt for x in node.operands] for node in GRAPHS["edge"].operations if node.kind == "mul"]
    wide = [product for product in products if min(q.width for q in product) > Cost().narrow]
    assert len(wide) <= 24  # of 18 bits: what one lane may take of an ECP5
    assert all(q.width <= Formats().operand for product in products for q in product)


def test_what_outputs_do_not_need_is_dropped():
    graph = Graph()
    x = graph.input("x", Q(4, 0))
    doubled, unused, small = x + x, x * x, x < 3
    small.fault("x is small")
    graph.name_and_prune({"y": doubled, "z": unused, "x": doubled - 1, "small": small}, ["y"])
    assert [n.kind for n in graph.operations] == ["input", "add", "const", "less"]
    assert graph.outputs == {"y": doubled} and doubled.name == "y"


def test_a_quantity_with_the_name_of_an_input_is_its_next_value():
    graph = Graph()
    x = graph.input("x", Q(4, 0))
    graph.name_and_prune({"x": x + 1}, ["x"])
    assert [n.name for n in graph.operations] == ["x", "x_next_const", "x_next"]
    assert graph.outputs["x"].name == "x_next"


def test_integers_and_bits_become_operations():
    graph = Graph()
    x = graph.input("x", Q(-1, 5))
    assert (3 - x).operands[0].fmt == Q(2, 0, signed=False)
    assert (x < 0).fmt == BIT
    assert (x < 0).select(0, x).fmt == x.fmt and (x < 0).select(x, 0).fmt == x.fmt


def test_a_graph_knows_its_faults():
    graph = Graph()
    x = graph.input("x", Q(4, 0))
    negative = x < 0
    negative.fault("x is negative")
    rounded, shifted = x.to(Q(3, 0, name="small")), x.to(Q(2, 0, name="shifted"), right=graph.const(1, BIT))
    quantities = {"a": rounded, "b": shifted, "silent": x.to(Q(1, 0)), "negative": negative}
    graph.name_and_prune(quantities, ["a", "b", "silent"])
    assert graph.fault_names == ["shifted", "small", "x is negative"]
