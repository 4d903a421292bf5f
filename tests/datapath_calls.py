"""The equations of an edge and of a node, called with the named inputs of their graphs."""

from types import SimpleNamespace

from golden.datapath import records
from golden.datapath.edge import edge
from golden.datapath.node import node
from golden.datapath.rk4 import RK4


def call_edge(fmt, tables, count, inputs):
    """Call `golden.datapath.edge.edge` on the inputs of `golden.datapath.graphs.edge_graph` for ``count`` tables."""
    i, j = (SimpleNamespace(x=_vector(inputs, f"{end}_x"), v=_vector(inputs, f"{end}_v")) for end in "ij")
    material = _record(inputs, "material", records.material(fmt, count))
    state = _record(inputs, "edge", records.edge_state(fmt))
    return edge(fmt, tables, _stage(inputs), inputs["velocity_shift"], material, i, j, state)


def call_node(fmt, banks, inputs):
    """Call `golden.datapath.node.node` on the inputs of `golden.datapath.graphs.node_graph`."""
    pulls = [_vector(inputs, f"pull{bank}") for bank in range(banks)]
    mass = _record(inputs, "inverse_mass", records.inverse_mass(fmt))
    state = SimpleNamespace(**{name: _vector(inputs, name) for name in records.node_state(fmt)})
    return node(fmt, _stage(inputs), inputs["velocity_shift"], pulls, _vector(inputs, "load"), mass, state)


def _stage(inputs):
    return _record(inputs, "stage", RK4.stage(0))


def _record(inputs, prefix, names):
    return SimpleNamespace(**{name: inputs[f"{prefix}_{name}"] for name in names})


def _vector(inputs, name):
    return [inputs[f"{name}_{axis}"] for axis in "xyz"]
