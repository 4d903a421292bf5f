"""A lane: an edge processor, the memories of its edges, its copy of the nodes and its sums of forces."""

from amaranth.hdl import Cat, Module, Mux, ResetSignal, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath import records
from golden.numbers.graph import AXES
from hw.machine.accumulator import ANNOUNCED, WRITTEN, Accumulator
from hw.machine.edge import EdgeDatapath, EdgeProcessor
from hw.machine.edge_memories import edge_memories
from hw.machine.interfaces import Advance, LaneAccess, NodeSums, NodeUpdate, StageBits, named
from hw.machine.issue_register import IssueRegister
from hw.machine.issued import FETCHED, IssuedEdge
from hw.machine.material_memories import material_memories
from hw.machine.node_copies import node_copies
from hw.machine.routes import HANDOVER, PORT, STAGED
from hw.parameters import Parameters
from hw.pipeline.delay import DelayLines
from hw.pipeline.operations import shape

ENTRY = records.edge_entry()


def written(datapath: EdgeDatapath, output: str) -> int:
    """Return the cycles from the issue of an edge to its new word, an output, in the memory."""
    return FETCHED + datapath.ready(output) + PORT


def latency(datapath: EdgeDatapath) -> int:
    """Return the cycles from the issue of an edge to the first in which the sums with its force can be read."""
    return FETCHED + datapath.ready("pull_x") + WRITTEN


def members(parameters: Parameters, datapath: EdgeDatapath) -> dict:
    """Return the ports of a lane."""
    p, fmt = parameters, parameters.formats
    materials, table = len(records.material(fmt, p.tables)), records.damper_word(fmt).width
    return {
        "flush": In(1),
        "row": In(Advance()),
        "next_row": In(p.row_bits),
        "next_edge": In(ENTRY.width),
        "node": In(Advance()),
        "next_node_row": In(p.node_row_bits),
        "stage": In(StageBits()),
        "velocity_shift": In(shape(fmt.exponent)),
        "update_row": In(p.node_row_bits),
        "update": In(NodeUpdate(fmt)).array(p.updates),
        "sums": Out(NodeSums(fmt)).array(p.updates),
        "fault": Out(len(datapath.faults)),
        "host": In(LaneAccess(p, materials=materials, table=table)),
    }


class Lane(wiring.Component):
    """Takes an edge per cycle: reads its nodes and its own state, processes it, adds its force to the sums of both
    nodes.

    Latency: the sums of an edge can be read `latency` cycles after it was issued. Throughput one edge per cycle.

    The lane has issue registers of its own, near the memories whose addresses they hold; in every lane they advance in
    the same cycles.

    Members
    -------
    flush : In(1)
        Empty the issue registers.
    row : In(Advance), next_row, next_edge : In
        The edge that is fetched: its index in the lane's memories, its list's entry.
    node : In(Advance), next_node_row : In
        The row of nodes that is fetched. The sums that are read are those of the row in the issue register.
    stage : In(StageBits)
        The stage of the edge that was in the issue register `hw.machine.routes.STAGED` cycles before.
    velocity_shift : In
        Constant while steps are run.
    update_row : In, update : In(NodeUpdate) for each updater
        The new states of the nodes of a row.
    sums : Out(NodeSums) for each updater
    fault : Out
        One bit for each name in ``datapath.faults``.
    host : In(LaneAccess)
    """

    def __init__(self, parameters: Parameters, datapath: EdgeDatapath):
        self.parameters, self.datapath = parameters, datapath
        super().__init__(members(parameters, datapath))

    def elaborate(self, platform):
        m, p, datapath = Module(), self.parameters, self.datapath
        lines, host = DelayLines(m), self.host
        # A register for the lane's own reset, because the routes from the circuit's reset are long
        reset = Signal(name="local_reset", reset_less=True)
        m.d.sync += reset.eq(ResetSignal())
        m.submodules.edge_processor = edge = EdgeProcessor(datapath)
        inputs, outputs = named(edge.inputs), named(edge.outputs)
        m.d.comb += edge.reset.eq(reset)

        row = self._issue_register(m, "row", self.row, Cat(self.next_edge, self.next_row))
        node = self._issue_register(m, "node", self.node, self.next_node_row)
        issued = IssuedEdge(lines, p, row)
        memories = {
            **node_copies(m, lines, p, datapath, issued, self.update_row, self.update, host),
            **edge_memories(m, lines, p, datapath, issued, outputs, host),
            **material_memories(m, lines, p, datapath, issued, host),
        }
        for name, word in memories.items():
            m.d.comb += inputs[name].eq(word)
        m.d.comb += edge.valid.eq(issued.at("valid", 0))
        m.d.comb += inputs["velocity_shift"].eq(lines.later(self.velocity_shift, 2))
        for bit, value in named(self.stage).items():
            name = f"stage_{bit}"
            near = Signal(name=f"{name}_near", reset_less=True)
            m.d.sync += near.eq(value)
            cycles = FETCHED + datapath.schedule.arrival[name] - STAGED - 1
            m.d.comb += inputs[name].eq(lines.later(near, cycles, name=name))
        for port, value in (
            (edge.table_write, host.write.table),
            (edge.table_address, host.index),
            (edge.table_data, host.data),
            (edge.table_read, host.active),
        ):
            m.d.sync += port.eq(lines.later(value, HANDOVER - 1, reset=True))
        m.d.comb += host.words.table.eq(edge.table_word)
        self._sums(m, reset, issued, outputs, node.entry)
        fault = Signal(len(self.fault), name="fault_register", reset_less=True)
        m.d.sync += fault.eq(Mux(reset, 0, edge.fault))
        m.d.comb += self.fault.eq(fault)
        lines.build()
        return m

    def _issue_register(self, m, name, advance, following) -> IssueRegister:
        m.submodules[f"{name}_issue"] = register = IssueRegister(width=len(following))
        wiring.connect(m, wiring.flipped(advance), register.advance)
        m.d.comb += [register.flush.eq(self.flush), register.next.eq(following)]
        return register

    def _sums(self, m, reset, issued, outputs, sum_row):
        p, ready = self.parameters, {self.datapath.ready(f"pull_{axis}") for axis in AXES}
        assert len(ready) == 1, "the components of a force come in the same cycle"
        announced = ready.pop() - ANNOUNCED
        for end in "ij":
            sums = Accumulator(formats=p.formats, nodes=p.nodes, updates=p.updates, subtract=end == "j")
            m.submodules[f"sums_{end}"] = sums
            m.d.comb += [
                sums.reset.eq(reset),
                sums.valid.eq(issued.at("valid", announced)),
                sums.node.eq(issued.at(end, announced)),
                sums.first.eq(issued.at(f"{end}_first", announced)),
                sums.sum_row.eq(sum_row),
                *(port.eq(outputs[f"pull_{axis}"]) for axis, port in named(sums.pull).items()),
            ]
            for n, total in enumerate(sums.sums):
                wiring.connect(m, total, wiring.flipped(self.sums[n].i if end == "i" else self.sums[n].j))
