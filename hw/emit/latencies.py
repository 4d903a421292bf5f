"""The latencies of a circuit, for the manifest and the documentation."""

from hw.blocks.memory import READ_LATENCY
from hw.link.bound import longest, one_word
from hw.link.items import Items
from hw.machine.core import datapaths
from hw.machine.edge_memories import NEXT
from hw.machine.host_port import LATENCY as HOST_LATENCY
from hw.machine.issued import FETCHED
from hw.machine.lane import latency as sums_latency
from hw.machine.lane import written
from hw.machine.latency import Latencies
from hw.machine.routes import COPIED
from hw.parameters import Parameters


def latencies(p: Parameters) -> list[tuple[str, str, int]]:
    """Return (part, from where to where, cycles) of each latency. Each comes from the component that has it."""
    (edge, node), loop = datapaths(p), Latencies.of(p)
    exchange, items = "an exchange waits for the end of a step as well", Items.of_word(p.formats.state)
    last = max(written(edge, name) for name in NEXT.values())
    return [
        ("block RAM", "address to word", READ_LATENCY),
        ("edge", "issue to its force on both nodes", FETCHED + edge.ready("pull_x")),
        ("edge", "issue to the sums that contain its force", sums_latency(edge)),
        ("edge", "issue to its new ratio in the memory", last),
        ("node", "issue to its new state in the lanes' memories", node.latency + COPIED),
        ("stage", "issue of an edge to its issue in the next stage, at least", loop.edge + loop.node),
        ("host port", "request to answer", HOST_LATENCY),
        ("link", "end of a command that reads a word to its answer, at most", one_word(items)),
        ("link", f"end of any command to its answer, at most; {exchange}", longest(items)),
    ]
