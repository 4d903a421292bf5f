"""The latencies that decide how long a run takes."""

from dataclasses import dataclass

from hw.machine import entry_memory, fetch, row_issue
from hw.machine.completion_counter import LATENCY as COUNTER_LATENCY
from hw.machine.core import LOADING, completions, datapaths
from hw.machine.issue_register import LATENCY as ISSUE_LATENCY
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
        done = completions(*datapaths(p))
        edge, node = (cycles + COUNTER_LATENCY + ISSUE_LATENCY for cycles in done)
        memories = row_issue.data_latency(p), entry_memory.LATENCY
        rows, nodes = (LOADING + fetch.latency(data) + ISSUE_LATENCY for data in memories)
        nodes += p.cycles_per_node > 1  # it is not found ready before it is in the issue register
        return cls(edge, node, rows, nodes)
