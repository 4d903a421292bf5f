"""The datapath of a node updater with its schedule."""

from functools import cached_property

from golden.datapath.formats import Formats
from golden.datapath.graphs import node_graph
from golden.numbers.graph import AXES, SERIAL_AXIS
from hw.machine.accumulator import READ
from hw.pipeline.cost import Cost
from hw.pipeline.schedule import Schedule

GATHERED = READ + 1
"""Cycles from the issue of a node to its sums of forces in registers: they come from all lanes."""


class NodeDatapath:
    """`golden.datapath.graphs.node_graph` with its schedule.

    Only the sums of forces come with the node, two for each lane; a node's own words are read when they are needed.
    With more than one of ``cycles_per_node``, as many as a node has axes, these come one after the other.
    """

    def __init__(self, formats: Formats, lanes: int, cost: Cost, cycles_per_node: int = 1):
        self.formats, self.cost, self.banks, self.cycles_per_node = formats, cost, 2 * lanes, cycles_per_node
        self.axes = AXES if cycles_per_node == 1 else SERIAL_AXIS

    @cached_property
    def graph(self):
        graph = node_graph(self.formats, self.banks, self.axes)
        graph.prune({name: node for name, node in graph.outputs.items() if "base_next" not in name})
        return graph

    @cached_property
    def schedule(self):
        late = {name for name in self.graph.inputs if not name.startswith(("pull", "velocity_shift", "first_axis"))}
        return Schedule(self.graph, self.cost, late=late, static={"velocity_shift"})

    @cached_property
    def faults(self) -> list[str]:
        """The names of all faults that the datapath can report, sorted."""
        return self.graph.fault_names

    @property
    def done(self) -> int:
        """The cycle in which all results, rounded, are in registers: their routes from there are long."""
        return self.schedule.latency + 1

    @property
    def latency(self) -> int:
        """Cycles from the issue of a node to its new state."""
        return GATHERED + self.cycles_per_node - 1 + self.done
