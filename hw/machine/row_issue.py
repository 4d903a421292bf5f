"""Rows of edges: their lists, and when each row is issued."""

from amaranth.hdl import Cat, Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath import records
from hw.blocks import highest
from hw.machine import entry_memory
from hw.machine.entry_memory import EntryMemory
from hw.machine.interfaces import Advance, Completion, EntryAccess, ListControl
from hw.machine.list_issue import ListIssue
from hw.parameters import Parameters
from hw.pipeline.delay import DelayLines

ENTRY = records.edge_entry()


def data_latency(p: Parameters) -> int:
    """Return the cycles from a row's address to its edges and the highest of their nodes."""
    return entry_memory.LATENCY + highest.latency(2 * p.lanes)


class RowIssue(wiring.Component):
    """Reads a row, one edge for each lane, from the lanes' lists and issues it as soon as its nodes are updated. Nodes
    are updated in rows, so it waits for the highest row that one of them is in.

    Parameters
    ----------
    parameters : Parameters
    latency : int
        Cycles from the issue of a row until its forces are in the sums that are read.

    Members
    -------
    flush, clear, count, control, advance, others, completion
        As in `hw.machine.list_issue.ListIssue`.
    host : In(EntryAccess) for each lane
    next_index, next_edges : Out
        The row that is fetched for the issue registers, and its edges.
    edges : Out(lanes)
        A bit for each lane that gets an edge from the row in the issue register.
    """

    def __init__(self, parameters: Parameters, latency: int):
        self._parameters, self._latency, p = parameters, latency, parameters
        super().__init__(
            {
                "flush": In(1),
                "clear": In(1),
                "count": In(p.row_bits + 1),
                "host": In(EntryAccess(p.row_bits, ENTRY.width)).array(p.lanes),
                "control": Out(ListControl()),
                "advance": Out(Advance()),
                "next_index": Out(p.row_bits),
                "next_edges": Out(ENTRY.width).array(p.lanes),
                "edges": Out(p.lanes),
                "others": In(Completion()),
                "completion": Out(Completion()),
            }
        )

    def elaborate(self, platform):
        m, p = Module(), self._parameters
        lines, size = DelayLines(m), ENTRY.width * p.lanes
        m.submodules.row_highest = last = highest.Highest(count=2 * p.lanes, width=p.node_row_bits)
        m.submodules.list_issue = issue = ListIssue(
            index_bits=p.row_bits,
            width=size + p.node_row_bits,
            data_latency=data_latency(p),
            need=slice(size, size + p.node_row_bits),
            first=0,
            latency=self._latency,
        )
        words = []
        for number, host in enumerate(self.host):
            m.submodules[f"entries{number}"] = entries = EntryMemory(width=ENTRY.width, depth=p.rows)
            wiring.connect(m, wiring.flipped(host), entries.host)
            m.d.comb += entries.address.eq(issue.address)
            words.append(entries.entry)
        edges = [ENTRY.unpack(word) for word in words]
        ends = [p.node_address(edge[end])[0][: p.node_row_bits] for edge in edges for end in "ij"]
        compared = highest.latency(2 * p.lanes)
        later = [lines.later(word, compared, name=f"entry{number}") for number, word in enumerate(words)]
        wiring.connect(m, issue.control, wiring.flipped(self.control))
        wiring.connect(m, issue.advance, wiring.flipped(self.advance))
        wiring.connect(m, issue.completion, wiring.flipped(self.completion))
        wiring.connect(m, wiring.flipped(self.others), issue.others)
        m.d.comb += [
            issue.flush.eq(self.flush),
            issue.clear.eq(self.clear),
            issue.count.eq(self.count),
            last.valid.eq(Cat(edge["valid"].replicate(2) for edge in edges)),
            last.numbers.eq(Cat(*ends)),
            issue.data.eq(Cat(*later, last.highest)),
            self.next_index.eq(issue.next_index),
            Cat(*self.next_edges).eq(issue.next_word[:size]),
            self.edges.eq(Cat(ENTRY.field("valid", issue.word.word_select(n, ENTRY.width)) for n in range(p.lanes))),
        ]
        lines.build()
        return m
