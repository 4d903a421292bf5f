"""The latencies of a circuit, for the documentation and the manifest."""

from .blocks.memory import READ_LATENCY
from .core import Core
from .host import LATENCY as HOST_LATENCY
from .lane import NEXT
from .lane import latency as sums_latency


def latencies(core: Core) -> list[tuple[str, str, int]]:
    """(of what, from where to where, cycles), each read from the component that has it."""
    edge, node = core.datapath, core.updater
    written = READ_LATENCY + max(edge.ready(name) for name in NEXT.values())
    return [
        ("block RAM", "address to word", READ_LATENCY),
        ("edge", "issue to its force on both nodes", READ_LATENCY + edge.ready("pull_x")),
        ("edge", "issue to the sums that contain its force", sums_latency(edge)),
        ("edge", "issue to its new ratio in the memory", written),
        ("node", "issue to its new state in the memories", node.latency),
        ("stage", "an edge to the next edge of the same node, at least", sums_latency(edge) + node.latency),
        ("host port", "request to answer", HOST_LATENCY),
    ]
