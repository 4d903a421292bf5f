"""The wavefront: which row of edges and which node may go next. No barrier between stages or steps."""

from amaranth.hdl import Const, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath.rk4 import RK4
from hw.machine.interfaces import ListControl

STAGE_BITS = max(1, (RK4.stages - 1).bit_length())


class Sequencer(wiring.Component):
    """Issues rows (one edge for every lane) and nodes in the order of their lists, each as soon as it may.

    A row of a stage may go when its nodes have been updated in the stage before; a node may go when all its edges have
    been summed in its own stage. Rows and nodes go in the order of their lists, stage after stage, so that two counters
    are all the synchronisation there is. A node's update needs only rows of its own stage, and a row only updates of
    the stage before, so no order of the lists can deadlock. `hw.machine.completion_counter` counts the entries that are
    done in a stage; the sequencer keeps the stages.

    Parameters
    ----------
    step_bits : int
    cycles_per_node : int
        Cycles from a node to the next, at least.

    Members
    -------
    start : In(1), steps : In
        Begin a run of ``steps`` steps, at least 1; only while not ``busy``.
    stop : In(1)
        End the run with the step that the updates are in, or with the next if they are past its first stage.
    busy : Out(1), steps_done : Out
        A run is under way; steps that are done, a cycle late.
    row, node : In(ListControl)
        A row waits for nodes updated in the stage that the updates are in, a node for rows summed in the stage that the
        sums are in.
    row_stage, node_stage : Out
        The stage of the entry in the issue register.
    rows_done, nodes_done : In(1)
        The forces of a list's last row can be read; the new state of a list's last node has been written.
    node_waits, list_waits, end_waits : Out(1)
        Why no row is issued in this cycle of the run: it waits for its nodes, it has not been fetched, or it was the
        last.
    """

    def __init__(self, *, step_bits: int = 32, cycles_per_node: int = 1):
        self._cycles_per_node = cycles_per_node
        super().__init__(
            {
                "start": In(1),
                "steps": In(step_bits),
                "stop": In(1),
                "busy": Out(1),
                "steps_done": Out(step_bits),
                "row": In(ListControl()),
                "node": In(ListControl(next_last=True)),
                "row_stage": Out(STAGE_BITS),
                "node_stage": Out(STAGE_BITS),
                "rows_done": In(1),
                "nodes_done": In(1),
                "node_waits": Out(1),
                "list_waits": Out(1),
                "end_waits": Out(1),
            }
        )

    def elaborate(self, platform):
        m, row, node = Module(), self.row, self.node
        last_stage = RK4.stages - 1
        # What the start of a run sets needs no reset: before it no row and no node is issued
        rows_over, nodes_over = (Signal(name=f"{name}_over", reset_less=True) for name in ("rows", "nodes"))
        last_step = {name: Signal(name=f"{name}_last_step", reset_less=True) for name in ("row", "node", "update")}
        row_lead = Signal(2, name="row_lead", reset_less=True)  # stages that the next row is ahead of the updates
        sum_lead = Signal(2, name="sum_lead", reset_less=True)  # stages that the sums are ahead of the next node
        row_stage, node_stage, update_stage = stages = [
            Signal(STAGE_BITS, name=f"stage_of_{name}", reset_less=True) for name in ("rows", "nodes", "updates")
        ]
        m.d.comb += [self.row_stage.eq(row_stage), self.node_stage.eq(node_stage)]

        # After a list's last entry comes its first, of the next stage
        row_wraps, node_wraps = row.valid & row.last, node.valid & node.last
        rows_end = rows_over | row_wraps & (row_stage == last_stage) & last_step["row"]
        nodes_end = nodes_over | node_wraps & (node_stage == last_stage) & last_step["node"]
        row_one_stage_ahead = (row_lead == 1) & ~row_wraps | (row_lead == 0) & row_wraps
        next_node_summed = node.next_reached & ~node.next_last
        node_ready = ~nodes_over & ((sum_lead != 0) | node.reached & ~node.last)
        node_next_ready = ~nodes_end & ((sum_lead > node_wraps) | (sum_lead == node_wraps) & next_node_summed)
        if self._cycles_per_node > 1:
            node_ready, node_next_ready = node_ready & self._rested(m), Const(0)
        m.d.comb += [
            row.ready.eq(~rows_over & ((row_lead == 0) | (row_lead == 1) & row.reached)),
            row.next_ready.eq(~rows_end & ((row_lead == 0) & ~row_wraps | row_one_stage_ahead & row.next_reached)),
            node.ready.eq(node_ready),
            node.next_ready.eq(node_next_ready),
            self.node_waits.eq(self.busy & ~rows_over & row.valid & ~row.issue),
            self.list_waits.eq(self.busy & ~rows_over & ~row.valid),
            self.end_waits.eq(self.busy & rows_over),
        ]

        # The rows' stage goes up with the list's last row, the updates' stage with the list's last node
        row_stage_done = Signal()
        node_stage_done = Signal()
        sum_stage_done, update_stage_done = self.rows_done, self.nodes_done
        m.d.comb += [row_stage_done.eq(row.issue & row.last), node_stage_done.eq(node.issue & node.last)]
        m.d.sync += [
            row_lead.eq(row_lead + row_stage_done - update_stage_done),
            sum_lead.eq(sum_lead + sum_stage_done - node_stage_done),
        ]
        # While the updates are in a step's first stage, rows and nodes are in the same step, none of them near its end
        stopping = Signal()
        stops = Signal()
        m.d.comb += stops.eq(stopping & (update_stage == 0))
        with m.If(self.stop):
            m.d.sync += stopping.eq(1)

        # The last stage of a step ends for its rows, nodes and updates in turn. The steps are counted a cycle later; a
        # step takes long enough for the count to tell in time which one is the last
        for name, stage, done in (
            ("row", row_stage, row_stage_done),
            ("node", node_stage, node_stage_done),
            ("update", update_stage, update_stage_done),
        ):
            step_done = Signal(name=f"{name}_step_done")
            counted = Signal(name=f"{name}_step_counted")
            left = Signal(len(self.steps), name=f"{name}_steps_left", reset_less=True)
            m.d.comb += step_done.eq(done & (stage == last_stage))
            m.d.sync += [counted.eq(step_done), last_step[name].eq(left == 1)]
            with m.If(done):
                m.d.sync += stage.eq(Mux(step_done, 0, stage + 1))
            with m.If(counted):
                m.d.sync += left.eq(left - 1)
            with m.If(stops):
                m.d.sync += left.eq(1)
            if name == "update":
                m.d.sync += self.steps_done.eq(self.steps_done + counted)
            with m.If(self.start):
                m.d.sync += [counted.eq(0), left.eq(self.steps)]
            with m.If(step_done & last_step[name]):
                m.d.sync += {"row": rows_over.eq(1), "node": nodes_over.eq(1), "update": self.busy.eq(0)}[name]

        with m.If(self.start):
            m.d.sync += [signal.eq(0) for signal in (*stages, row_lead, sum_lead, rows_over, nodes_over)]
            m.d.sync += [stopping.eq(0), self.busy.eq(1), self.steps_done.eq(0)]
        return m

    def _rested(self, m):
        """Return 1 if a node that is ready now will be issued after the cycles of the node before it."""
        rest = Signal(range(self._cycles_per_node), name="rest")
        with m.If(self.node.issue):
            m.d.sync += rest.eq(self._cycles_per_node - 2)
        with m.Elif(rest != 0):
            m.d.sync += rest.eq(rest - 1)
        return rest == 0
