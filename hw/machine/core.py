"""The coprocessor: lanes, node updaters, lists, sequencer and host port. Connections only."""

from amaranth.hdl import Array, Cat, Module, Mux, Signal, Value
from amaranth.lib import wiring

from golden.datapath.rk4 import RK4
from hw.machine.access import Access
from hw.machine.edge import EdgeDatapath
from hw.machine.edge_memories import NEXT
from hw.machine.host_port import HostPort
from hw.machine.interfaces import HostBus, named
from hw.machine.lane import Lane, latency, written
from hw.machine.node_datapath import NodeDatapath
from hw.machine.node_issue import NodeIssue
from hw.machine.routes import COPIED, HANDOVER, STAGED
from hw.machine.row_issue import RowIssue
from hw.machine.sequencer import Sequencer
from hw.machine.serial_updater import SerialNodeUpdater
from hw.machine.updater import NodeUpdater
from hw.map.control import COUNTERS
from hw.map.memory_map import Map
from hw.parameters import Parameters
from hw.pipeline.delay import DelayLines

LOADING = HANDOVER + 1
"""Cycles from the start of a run to the end of the flush of its lists: the host's last writes must have arrived."""

TOP = "rheogate"
"""The Verilog module of the circuit."""


def datapaths(p: Parameters) -> tuple[EdgeDatapath, NodeDatapath]:
    """Return the datapaths of an edge and of a node."""
    return EdgeDatapath(p.formats, p.tables, p.cost), NodeDatapath(p.formats, p.lanes, p.cost, p.cycles_per_node)


def faults(edge: EdgeDatapath, node: NodeDatapath) -> list[str]:
    """Return the names of the bits of the control register ``FAULTS``."""
    return sorted({*edge.faults, *node.faults})


def completions(edge: EdgeDatapath, node: NodeDatapath) -> tuple[int, int]:
    """Return two counts of cycles: from the issue of a row of edges to the cycle before its sums can be read, and from
    the issue of a row of nodes to its new states in the lanes."""
    return latency(edge) - 1, node.latency + COPIED


class Core(wiring.Component):
    """The whole circuit behind its host port (`hw.machine.interfaces.HostBus`).

    Parameters
    ----------
    parameters : Parameters
    lane : callable
        Makes a lane from the parameters and the edge's datapath: a `Lane`, or an instance of its Verilog module.

    Attributes
    ----------
    faults : list of str
        Names of the bits of the control register ``FAULTS``.

    Raises
    ------
    ValueError
        If an edge's own words are not written before its nodes are updated: then it may be issued again, or read by the
        host.
    """

    def __init__(self, parameters: Parameters, lane=Lane):
        self.parameters, self._make_lane = parameters, lane
        self.datapath, self.node_datapath = datapaths(parameters)
        self.faults = faults(self.datapath, self.node_datapath)
        loop = latency(self.datapath) + self.node_datapath.latency + COPIED
        for word, output in NEXT.items():
            if (cycles := written(self.datapath, output)) > loop:
                raise ValueError(f"the edge's {word} must be written within {loop} cycles, not after {cycles}")
        super().__init__(HostBus(parameters.formats.state).flip())

    def elaborate(self, platform):
        m, p = Module(), self.parameters
        lines = DelayLines(m)
        row_latency, node_latency = completions(self.datapath, self.node_datapath)
        m.submodules.host = host = HostPort(Map(p), len(self.faults))
        m.submodules.sequencer = sequencer = Sequencer(cycles_per_node=p.cycles_per_node)
        m.submodules.rows = rows = RowIssue(p, row_latency)
        m.submodules.nodes = nodes = NodeIssue(p, node_latency)
        make_updater = NodeUpdater if p.cycles_per_node == 1 else SerialNodeUpdater
        updaters = [make_updater(p, self.node_datapath) for _ in range(p.updates)]
        lanes = [self._make_lane(p, self.datapath) for _ in range(p.lanes)]
        for name, parts in (("updater", updaters), ("lane", lanes)):
            for number, part in enumerate(parts):
                m.submodules[f"{name}{number}"] = part

        idle, loading = self._idle(m, lines, sequencer.busy)
        access = Access(m, lines, p, host.memories, idle, loading)
        access.to_nodes([updater.host for updater in updaters], nodes.host)
        access.to_lanes([lane.host for lane in lanes], rows.host)
        self._lists(m, host, sequencer, rows, nodes, loading)
        # A register on the route to updaters and lanes, which are far from the host port
        velocity_shift = lines.later(host.velocity_shift, 1, name="velocity_shift")
        self._lanes(m, lines, lanes, updaters, rows, nodes, sequencer.row_stage, loading, velocity_shift)
        self._updaters(m, updaters, lanes, nodes, sequencer.node_stage, velocity_shift)
        self._host(m, host, sequencer, rows)
        self._faults(m, host, lanes, updaters)
        lines.build()
        return m

    def _idle(self, m, lines, busy) -> tuple[Value, Value]:
        """Return two bits: ``idle``, the host has the memories of lanes and updaters; ``loading``, it has those of the
        lists, until its last writes before a run have arrived."""
        idle = Signal(init=1)
        loading = Signal(init=1)
        m.d.sync += idle.eq(~busy)
        past = [lines.later(idle, cycles, name="idle", reset=True) for cycles in range(LOADING - 1)]
        m.d.sync += loading.eq(Cat(~busy, *past).any())
        return idle, loading

    def _lists(self, m, host, sequencer, rows, nodes, loading):
        wiring.connect(m, rows.control, sequencer.row)
        wiring.connect(m, nodes.control, sequencer.node)
        wiring.connect(m, rows.completion, nodes.others)
        wiring.connect(m, nodes.completion, rows.others)
        for issue, count in ((rows, host.rows), (nodes, host.nodes)):
            m.d.comb += [issue.flush.eq(loading), issue.clear.eq(sequencer.start), issue.count.eq(count)]
        m.d.comb += [
            sequencer.rows_done.eq(rows.completion.last),
            sequencer.nodes_done.eq(nodes.completion.last),
        ]

    def _lanes(self, m, lines, lanes, updaters, rows, nodes, stage, loading, velocity_shift):
        bits = {bit: lines.later(value, STAGED, name=f"stage_{bit}") for bit, value in stage_bits(stage).items()}
        wiring.connect(m, rows.advance, *(lane.row for lane in lanes))
        wiring.connect(m, nodes.advance, *(lane.node for lane in lanes))
        for n, updater in enumerate(updaters):
            wiring.connect(m, updater.update, *(lane.update[n] for lane in lanes))
        for lane, edge in zip(lanes, rows.next_edges, strict=True):
            m.d.comb += [
                lane.flush.eq(loading),
                lane.next_row.eq(rows.next_index),
                lane.next_edge.eq(edge),
                lane.next_node_row.eq(nodes.next_index),
                *(port.eq(bits[bit]) for bit, port in named(lane.stage).items()),
                lane.velocity_shift.eq(velocity_shift),
                lane.update_row.eq(updaters[0].update_row),
            ]

    def _updaters(self, m, updaters, lanes, nodes, stage, velocity_shift):
        bits = stage_bits(stage)
        for n, updater in enumerate(updaters):
            for number, lane in enumerate(lanes):
                wiring.connect(m, lane.sums[n], updater.sums[number])
            m.d.comb += [
                updater.valid.eq(nodes.valid[n]),
                updater.row.eq(nodes.index),
                updater.mask.eq(nodes.masks[n]),
                updater.velocity_shift.eq(velocity_shift),
                *(port.eq(bits[bit]) for bit, port in named(updater.stage).items()),
            ]

    def _host(self, m, host, sequencer, rows):
        wiring.connect(m, wiring.flipped(self), host.bus)
        m.d.comb += [
            sequencer.start.eq(host.start),
            sequencer.steps.eq(host.steps),
            sequencer.stop.eq(host.stop),
            host.busy.eq(sequencer.busy),
            host.steps_done.eq(sequencer.steps_done),
        ]
        events = {
            "cycles": sequencer.busy,
            "rows_issued": rows.control.issue,
            "edges_issued": Mux(rows.control.issue, sum(rows.edges), 0),
            "node_waits": sequencer.node_waits,
            "list_waits": sequencer.list_waits,
            "end_waits": sequencer.end_waits,
        }
        ports = named(host.counters)
        for name in COUNTERS.values():
            counter = Signal(len(ports[name]), name=name)
            event = Value.cast(events[name])
            counted = Signal.like(event, name=f"{name}_counted")  # a cycle later
            m.d.comb += ports[name].eq(counter)
            m.d.sync += [counted.eq(event), counter.eq(Mux(host.start, 0, counter + counted))]

    def _faults(self, m, host, lanes, updaters):
        fault = Signal(len(self.faults), name="fault")
        sources = [(self.datapath.faults, lane.fault) for lane in lanes]
        sources += [(self.node_datapath.faults, updater.fault) for updater in updaters]
        for number, name in enumerate(self.faults):
            bits = [bit[names.index(name)] for names, bit in sources if name in names]
            m.d.sync += fault[number].eq(Cat(*bits).any())
        m.d.comb += host.fault.eq(fault)


def stage_bits(stage: Value) -> dict[str, Value]:
    """Return the bits of `hw.machine.interfaces.StageBits` for a stage's number."""
    return {bit: Array([RK4.stage(s)[bit] for s in range(RK4.stages)])[stage] for bit in RK4.stage(0)}
