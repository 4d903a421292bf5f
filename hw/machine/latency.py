"""The latencies that decide how long a run takes."""

from dataclasses import dataclass

from hw.machine import entry_memory, fetch, row_issue
from hw.machine.completion_counter import LATENCY as COUNTER_LATENCY
from hw.machine.core import LOADING, completions, datapaths
from hw.machine.issue_register import LATENCY as ISSUE_LATENCY
from hw.parameters import Parameters


@dataclass(frozen=True)
class Latencies:
    """Latencies in cycles.

    Attributes
    ----------
    edge, node : int
        From the issue of an edge to that of a node that waited for it; from the issue of a node to that of an edge.
    rows, nodes : int
        From the start of a run to the issue of its first row of edges, and of its first row of nodes, if they wait for
        nothing.
    """

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
        nodes += p.cycles_per_node > 1  # found ready only once it is in the issue register
        return cls(edge, node, rows, nodes)
