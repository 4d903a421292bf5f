"""The latencies that decide how long a run takes."""

from dataclasses import dataclass

from hw.machine import entry_memory, fetch, row_issue
from hw.machine.core import datapaths
from hw.machine.issue_register import LATENCY as ISSUE_LATENCY
from hw.machine.lane import latency as sums_latency
from hw.machine.routes import COPIED, HANDOVER
from hw.parameters import Parameters


@dataclass(frozen=True)
class Latencies:
    """Cycles from the issue of an edge to that of nodes that waited for it, and from that of a node to the edges; from
    the start of a run to the issue of the first row of edges and the first of nodes, if they wait for nothing."""

    edge: int
    node: int
    rows: int
    nodes: int

    @classmethod
    def of(cls, p: Parameters) -> "Latencies":
        edge, node = datapaths(p)
        memories = row_issue.data_latency(p), entry_memory.LATENCY
        rows, nodes = (HANDOVER + fetch.latency(data) + ISSUE_LATENCY + 1 for data in memories)
        nodes += p.cycles_per_node > 1  # it is not found ready before it is in the issue register
        return cls(sums_latency(edge) + ISSUE_LATENCY, node.latency + COPIED + 1 + ISSUE_LATENCY, rows, nodes)
