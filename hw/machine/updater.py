"""A node updater: from the sums of forces on a node to the next stage's position and velocity."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import wiring

from golden.numbers.graph import AXES
from hw.machine.accumulator import READ
from hw.machine.interfaces import named
from hw.machine.node_datapath import GATHERED, NodeDatapath
from hw.machine.node_pipeline import Item, NodePipeline, banks, members
from hw.machine.routes import HANDOVER, PORT
from hw.parameters import Parameters
from hw.pipeline.delay import DelayLines


class NodeUpdater(wiring.Component):
    """`golden.datapath.node.node` as a pipeline, with the memories of its nodes, one of each row of nodes.
    `hw.machine.serial_updater.SerialNodeUpdater` has the same ports and takes an axis at a time.

    Latency: a node's new state is on ``update`` ``datapath.latency`` cycles after it was issued. Throughput one node in
    ``datapath.cycles_per_node`` cycles.

    Members
    -------
    valid, row : In
        A node is issued; its row.
    mask : In
        A bit for each accumulator that holds a force on it: first ends of all lanes, then second ends.
    stage : In(StageBits)
        The stage of the node that is issued.
    velocity_shift : In
        Constant while steps are run.
    sums : In(NodeSums) for each lane
    update : Out(NodeUpdate), update_row : Out
    fault : Out
        One bit for each name in ``datapath.faults``.
    host : In(UpdaterAccess)
    """

    def __init__(self, parameters: Parameters, datapath: NodeDatapath):
        self.parameters, self.datapath = parameters, datapath
        super().__init__(members(parameters, datapath))

    def elaborate(self, platform):
        m = Module()
        lines, bits = DelayLines(m), named(self.stage)
        item = Item(self.valid, self.valid, self.row, self.row, bits, GATHERED)
        carried = {axis: (axis,) for axis in AXES}
        address = lines.later(self.host.index, HANDOVER - PORT, reset=True)
        pipeline = NodePipeline(m, lines, self, item, carried, self.parameters.node_rows, address)
        unused = Signal.like(self.mask, name="unused_banks")
        m.d.comb += unused.eq(~self.mask)
        unused, inputs = lines.later(unused, READ), {}
        for bank, sums in enumerate(banks(self.sums)):
            for axis in AXES:
                pull = Signal.like(sums[axis], name=f"pull{bank}_{axis}", reset_less=True)
                m.d.sync += pull.eq(Mux(unused[bank], 0, sums[axis]))
                inputs[f"pull{bank}_{axis}"] = lines.later(pull, GATHERED - READ - 1)
        pipeline.build(inputs)
        lines.build()
        return m
