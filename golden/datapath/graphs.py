"""The graphs of an edge and of a node (`golden.numbers.graph`), with the names and formats of all their inputs and
outputs."""

from types import SimpleNamespace

from golden.datapath import records
from golden.datapath.edge import edge
from golden.datapath.formats import Formats
from golden.datapath.node import node
from golden.datapath.rk4 import RK4
from golden.numbers.graph import AXES, IN_TURN, Graph, Reader
from golden.numbers.qformat import BIT


def edge_graph(fmt: Formats, tables: int) -> Graph:
    """`golden.datapath.edge.edge` as a graph, for a circuit with room for ``tables`` damper tables.

    Inputs: ``stage_*``, ``velocity_shift``, ``material_*``, ``i_x_*``, ``i_v_*``, ``j_x_*``, ``j_v_*``,
    ``edge_length``, ``edge_base``, ``edge_ratio``, ``edge_total``. Outputs: ``pull_*``, ``base_next``, ``ratio_next``,
    ``total_next``.
    """
    graph = Graph()
    reader = Reader(graph, records.inverse_word(fmt), records.damper_word(fmt))
    stage, shift = _stage(graph), graph.input("velocity_shift", fmt.exponent)
    material = graph.record("material", records.material(fmt, tables))
    i, j = (
        SimpleNamespace(x=graph.vector(f"{end}_x", fmt.position), v=graph.vector(f"{end}_v", fmt.velocity))
        for end in "ij"
    )
    state = graph.record("edge", records.edge_state(fmt))
    values = edge(fmt, reader, stage, shift, material, i, j, state)
    graph.finish(values, ["pull", "base_next", "ratio_next", "total_next"])
    return graph


def node_graph(fmt: Formats, banks: int, axes: tuple[str, ...] = AXES) -> Graph:
    """`golden.datapath.node.node` as a graph, for ``banks`` accumulators a node.

    With the axes `golden.numbers.graph.IN_TURN` the components of a node's vectors come one after the other;
    ``first_turn`` is 1 with the first of them.

    Inputs: ``stage_*``, ``velocity_shift``, ``pull<bank>_*``, ``load_*``, ``inverse_mass_*``, ``x_base_*``,
    ``v_base_*``, ``v_*``, ``x_total_*``, ``v_total_*``. Outputs: ``force_*``, ``x_*``, ``v_*``, ``x_base_next_*``,
    ``v_base_next_*``, ``x_total_*``, ``v_total_*``.
    """
    graph = Graph(axes=axes)
    if axes == IN_TURN:
        graph.input("first_turn", BIT)
    stage, shift = _stage(graph), graph.input("velocity_shift", fmt.exponent)
    pulls = [graph.vector(f"pull{bank}", fmt.accumulator) for bank in range(banks)]
    load = graph.vector("load", fmt.accumulator)
    mass = graph.record("inverse_mass", records.inverse_mass(fmt))
    state = SimpleNamespace(**{name: graph.vector(name, q) for name, q in records.node_state(fmt).items()})
    outputs = ["force", "x", "v", "x_base_next", "v_base_next", "x_total", "v_total"]
    graph.finish(node(fmt, stage, shift, pulls, load, mass, state), outputs)
    return graph


def _stage(graph: Graph):
    return graph.record("stage", dict.fromkeys(RK4.stage(0), BIT))
