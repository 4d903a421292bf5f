"""Rows of nodes: their lists, and when each row is issued."""

from amaranth.hdl import Cat, Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath import records
from hw.machine import entry_memory
from hw.machine.entry_memory import EntryMemory
from hw.machine.interfaces import Advance, Completion, EntryAccess, ListControl
from hw.machine.list_issue import ListIssue
from hw.parameters import Parameters

ENTRY = records.node_entry()


class NodeIssue(wiring.Component):
    """Reads a row of nodes, one for each updater, from the updaters' lists and issues it as soon as the forces of all
    its edges are summed. All nodes of a row wait for the same number of rows of edges.

    Parameters
    ----------
    parameters : Parameters
    latency : int
        Cycles from the issue of a row of nodes until the lanes have its new states.

    Members
    -------
    flush, clear, count, control, advance, others, completion
        As in `hw.machine.list_issue.ListIssue`; ``count`` is of nodes.
    host : In(EntryAccess) for each updater
    next_index, index : Out
        The row of nodes that is fetched for the issue registers, and the one in them.
    valid, masks : Out
        A bit for each updater that is to take a node of the row in this cycle; the node's mask, for each updater.
    """

    def __init__(self, parameters: Parameters, latency: int):
        self._parameters, self._latency, p = parameters, latency, parameters
        super().__init__(
            {
                "flush": In(1),
                "clear": In(1),
                "count": In(p.node_bits + 1),
                "host": In(EntryAccess(p.node_row_bits, ENTRY.width)).array(p.updates),
                "control": Out(ListControl(next_last=True)),
                "advance": Out(Advance()),
                "next_index": Out(p.node_row_bits),
                "index": Out(p.node_row_bits),
                "valid": Out(p.updates),
                "masks": Out(2 * p.lanes).array(p.updates),
                "others": In(Completion()),
                "completion": Out(Completion()),
            }
        )

    def elaborate(self, platform):
        m, p = Module(), self._parameters
        need = ENTRY.offsets["need"]
        m.submodules.list_issue = issue = ListIssue(
            index_bits=p.node_row_bits,
            width=ENTRY.width * p.updates,
            data_latency=entry_memory.LATENCY,
            need=slice(need, need + p.row_bits + 1),
            first=1,  # a row of nodes needs as many rows of edges, a row of edges the row of nodes of that number
            latency=self._latency,
            next_last=True,
        )
        words = []
        for number, host in enumerate(self.host):
            m.submodules[f"entries{number}"] = entries = EntryMemory(width=ENTRY.width, depth=p.node_rows)
            wiring.connect(m, wiring.flipped(host), entries.host)
            m.d.comb += entries.address.eq(issue.address)
            words.append(entries.entry)
        wiring.connect(m, issue.control, wiring.flipped(self.control))
        wiring.connect(m, issue.advance, wiring.flipped(self.advance))
        wiring.connect(m, issue.completion, wiring.flipped(self.completion))
        wiring.connect(m, wiring.flipped(self.others), issue.others)
        nodes = [ENTRY.unpack(issue.word.word_select(n, ENTRY.width)) for n in range(p.updates)]
        m.d.comb += [
            issue.flush.eq(self.flush),
            issue.clear.eq(self.clear),
            issue.count.eq((self.count + (p.updates - 1)) >> p.updates.bit_length() - 1),
            issue.data.eq(Cat(*words)),
            self.next_index.eq(issue.next_index),
            self.index.eq(issue.index),
            self.valid.eq(Cat(issue.control.issue & node["valid"] for node in nodes)),
            *(mask.eq(node["mask"]) for mask, node in zip(self.masks, nodes, strict=True)),
        ]
        return m
