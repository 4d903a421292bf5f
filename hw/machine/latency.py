"""The latencies of a circuit, for the documentation and the manifest."""

from dataclasses import dataclass

from hw.blocks.memory import READ_LATENCY
from hw.link.bound import LONGEST, ONE_WORD
from hw.machine import fetch
from hw.machine.core import datapaths, row_latency
from hw.machine.entry_memory import LATENCY as LISTED
from hw.machine.host_port import HANDOVER
from hw.machine.host_port import LATENCY as HOST_LATENCY
from hw.machine.issue_register import LATENCY as ISSUE_LATENCY
from hw.machine.lane import COPIED, FETCHED, NEXT, written
from hw.machine.lane import latency as sums_latency
from hw.parameters import Parameters


@dataclass(frozen=True)
class Latencies:
    """Cycles from the issue of an edge to the nodes that may go then, and from that of a node to the edges; from the
    start of a run to the first row of edges and the first of nodes, if nothing keeps them."""

    edge: int
    node: int
    rows: int
    nodes: int

    @classmethod
    def of(cls, p: Parameters) -> "Latencies":
        edge, node = datapaths(p)
        rows, nodes = (HANDOVER + fetch.latency(data) + ISSUE_LATENCY + 1 for data in (row_latency(p), LISTED))
        nodes += p.cycles_per_node > 1  # the first of them doesn't go on its way to the front
        return cls(sums_latency(edge) + ISSUE_LATENCY, node.latency + COPIED + 1 + ISSUE_LATENCY, rows, nodes)


def latencies(p: Parameters) -> list[tuple[str, str, int]]:
    """(of what, from where to where, cycles), each read from the component that has it."""
    (edge, node), loop = datapaths(p), Latencies.of(p)
    last = max(written(edge, name) for name in NEXT.values())
    return [
        ("block RAM", "address to word", READ_LATENCY),
        ("edge", "issue to its force on both nodes", FETCHED + edge.ready("pull_x")),
        ("edge", "issue to the sums that contain its force", sums_latency(edge)),
        ("edge", "issue to its new ratio in the memory", last),
        ("node", "issue to its new state in the lanes' memories", node.latency + COPIED),
        ("stage", "an edge to the next edge of the same node, at least", loop.edge + loop.node),
        ("host port", "request to answer", HOST_LATENCY),
        ("link", "end of a command that reads a word to its answer, at most", ONE_WORD),
        ("link", "end of any command to its answer, at most; an exchange waits for the end of a step besides", LONGEST),
    ]
