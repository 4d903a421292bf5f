"""The equations return what the table of quantities lists, and the names of their variables don't matter."""

from collections import Counter

import numpy as np
import pytest
from datapath_calls import call_edge, call_node
from integer_objects import random_raw, random_record
from renaming import local_names, renamed

from golden.datapath import edge, graphs, node, quantities, records
from golden.datapath.formats import Formats
from golden.datapath.quantities import EDGE, NODE, QUANTITIES, Quantity, check_known, named, table
from golden.datapath.tables import Tables, inverse_table
from golden.numbers.graph import Graph, flatten
from golden.numbers.qarray import QArray
from golden.numbers.qformat import Q

FMT = Formats()
BUILD = {"edge": lambda: graphs.edge_graph(FMT, 2), "node": lambda: graphs.node_graph(FMT, 2)}


def rename_variables(monkeypatch, module, names):
    """Build graphs from the equations of a module with other names for its variables."""
    what = module.__name__.rpartition(".")[2]
    monkeypatch.setattr(graphs, what, renamed(module, names)[what])


def described(graph: Graph) -> list:
    """Return everything that the pipeline of a graph is made from."""
    number = {x: n for n, x in enumerate(graph.operations)}

    def known(x):
        return (x.name, x.quantity, x.kind, x.fmt, x.fmt.name, repr(x.detail), [number[y] for y in x.operands])

    ports = [(name, number[x]) for ports in (graph.inputs, graph.outputs) for name, x in ports.items()]
    return [*map(known, graph.operations), ports, [(name, number[x]) for name, x in graph.faults]]


@pytest.mark.parametrize("module", [edge, node], ids=["edge", "node"])
def test_no_variable_of_the_equations_has_a_name_that_matters(module, monkeypatch):
    """One after another, then all at once; a graph with the same names has the same schedule and the same Verilog."""
    build, names = BUILD[module.__name__.rpartition(".")[2]], local_names(module)
    before = described(build())
    assert {"edge": "stretch", "node": "acceleration"}[module.__name__.rpartition(".")[2]] in names and len(names) > 30
    for name in names:
        rename_variables(monkeypatch, module, {name: f"renamed_{name}"})
        assert described(build()) == before, name
    rename_variables(monkeypatch, module, {name: f"v{number}" for number, name in enumerate(names)})
    assert described(build()) == before


def test_integers_are_the_same_whatever_the_variables_are_called(monkeypatch, rng):
    fmt, tables, faults = FMT, 2, Counter()
    damper = random_record(rng, records.damper_word(fmt), (tables, 1 << fmt.damper_index.width))
    lookups = Tables(fmt, inverse_table(fmt), damper)

    def inputs(graph):
        raw = {name: random_raw(rng, x.fmt, 50) for name, x in graph.inputs.items()}
        raw |= {"material_table": rng.integers(tables, size=50)} if "material_table" in raw else {}
        return {name: QArray(values, graph.inputs[name].fmt, faults) for name, values in raw.items()}

    of_edge, of_node = inputs(graphs.edge_graph(fmt, tables)), inputs(graphs.node_graph(fmt, 2))

    def results():
        for values in (call_edge(fmt, lookups, tables, of_edge), call_node(fmt, 2, of_node)):
            yield {label: x.raw for name, value in values.items() for label, x in flatten(name, value)}

    before = list(results())
    for module, what in ((edge, "edge"), (node, "node")):
        contents = renamed(module, {name: f"renamed_{name}" for name in local_names(module)})
        monkeypatch.setattr(f"datapath_calls.{what}", contents[what])
    for old, new in zip(before, results(), strict=True):
        assert old.keys() == new.keys() and all(np.array_equal(old[name], new[name]) for name in old)


@pytest.mark.parametrize(("what", "rows"), [("edge", EDGE), ("node", NODE)])
def test_the_table_is_what_the_equations_return_and_each_quantity_is_an_operation(what, rows):
    graph = BUILD[what]()
    made = {x.quantity for x in graph.operations} - {""}
    assert made == {q.name for q in rows}


def test_each_quantity_stands_once_in_words_of_its_own():
    rows = (*EDGE, *NODE)
    assert len(QUANTITIES) == len(rows) and len({q.words for q in rows}) == len(rows)


def test_a_normalised_quantity_is_one_and_has_a_shift():
    """The unit of a normalised quantity's format is a power of two."""
    for build in BUILD.values():
        for x in build().operations:
            if x.quantity and QUANTITIES[x.quantity].measured and x.fmt.unit:
                assert QUANTITIES[x.quantity].normalised == ("shift" in x.fmt.unit), x.quantity


def test_a_name_that_the_table_lacks_is_refused():
    x = Graph().input("x", Q(4, 0))
    with pytest.raises(ValueError, match=r"must be listed in golden\.datapath\.quantities, not 'strech'"):
        named({"strech": x}, (Quantity("stretch", "stretch of the spring"),))


def test_a_quantity_that_the_equations_do_not_return_is_refused(monkeypatch):
    with pytest.raises(ValueError, match="must return every quantity of their table, not all but strain"):
        named({}, (Quantity("strain", "strain"),))
    monkeypatch.setattr(quantities, "EDGE", (*EDGE, Quantity("strain", "strain")))
    with pytest.raises(ValueError, match="not all but strain"):
        graphs.edge_graph(FMT, 1)


def test_a_misspelt_name_is_refused():
    check_known(["stretch", "pull"], "extra_register_after")
    with pytest.raises(
        ValueError, match=r"extra_register_after must name quantities of golden\.datapath\.quantities, not 'strech'"
    ):
        check_known(["stretch", "strech"], "extra_register_after")


def test_the_documented_table_has_a_row_for_each_quantity():
    _, _, *rows = table().splitlines()
    assert len(rows) == len(QUANTITIES) and "| edge | stretch | stretch of the spring | yes |" in rows
