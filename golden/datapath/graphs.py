"""The graphs of an edge and of a node, with the names and formats of all their inputs and outputs."""

from types import SimpleNamespace

from golden.datapath import quantities, records
from golden.datapath.edge import edge
from golden.datapath.formats import Formats
from golden.datapath.node import node
from golden.datapath.rk4 import RK4
from golden.numbers.graph import AXES, SERIAL_AXIS, Graph
from golden.numbers.qformat import BIT

EDGE_OUTPUTS = ["pull", "base_next", "ratio_next", "total_next"]
NODE_OUTPUTS = ["force", "x", "v", "x_base_next", "v_base_next", "x_total", "v_total"]


class TableReads:
    """The lookups of `golden.datapath.edge.edge` as operations of a graph."""

    def __init__(self, graph: Graph, fmt: Formats):
        self._graph, self._inverse, self._damper = graph, records.inverse_word(fmt), records.damper_word(fmt)

    def inverse(self, index):
        return self._graph.read("inverse", self._inverse, index)

    def damper(self, table, index):
        return self._graph.read("damper", self._damper, table, index)


def edge_graph(fmt: Formats, tables: int) -> Graph:
    """Return `golden.datapath.edge.edge` as a graph, for a circuit with room for ``tables`` damper tables.

    Inputs: ``stage_*``, ``velocity_shift``, ``material_*``, ``i_x_*``, ``i_v_*``, ``j_x_*``, ``j_v_*``,
    ``edge_length``, ``edge_base``, ``edge_ratio``, ``edge_total``. Outputs: ``pull_*``, ``base_next``, ``ratio_next``,
    ``total_next``.
    """
    graph = Graph()
    stage, shift = _stage(graph), graph.input("velocity_shift", fmt.exponent)
    material = graph.record("material", records.material(fmt, tables))
    i, j = (
        SimpleNamespace(x=graph.vector(f"{end}_x", fmt.position), v=graph.vector(f"{end}_v", fmt.velocity))
        for end in "ij"
    )
    state = graph.record("edge", records.edge_state(fmt))
    values = edge(fmt, TableReads(graph, fmt), stage, shift, material, i, j, state)
    graph.name_and_prune(quantities.named(values, quantities.EDGE), EDGE_OUTPUTS)
    return graph


def node_graph(fmt: Formats, banks: int, axes: tuple[str, ...] = AXES) -> Graph:
    """Return `golden.datapath.node.node` as a graph, for ``banks`` accumulators a node.

    With the axes `golden.numbers.graph.SERIAL_AXIS` the components of a node's vectors come one after the other;
    ``first_axis`` is 1 with the first of them.

    Inputs: ``stage_*``, ``velocity_shift``, ``pull<bank>_*``, ``load_*``, ``inverse_mass_*``, ``x_base_*``,
    ``v_base_*``, ``v_*``, ``x_total_*``, ``v_total_*``. Outputs: ``force_*``, ``x_*``, ``v_*``, ``x_base_next_*``,
    ``v_base_next_*``, ``x_total_*``, ``v_total_*``.
    """
    graph = Graph(axes=axes)
    if axes == SERIAL_AXIS:
        graph.input("first_axis", BIT)
    stage, shift = _stage(graph), graph.input("velocity_shift", fmt.exponent)
    pulls = [graph.vector(f"pull{bank}", fmt.accumulator) for bank in range(banks)]
    load = graph.vector("load", fmt.accumulator)
    mass = graph.record("inverse_mass", records.inverse_mass(fmt))
    state = SimpleNamespace(**{name: graph.vector(name, q) for name, q in records.node_state(fmt).items()})
    values = node(fmt, stage, shift, pulls, load, mass, state)
    graph.name_and_prune(quantities.named(values, quantities.NODE), NODE_OUTPUTS)
    return graph


def _stage(graph: Graph):
    return graph.record("stage", dict.fromkeys(RK4.stage(0), BIT))
