"""The wavefront: which row of edges and which node may go next. No barrier between stages or steps."""

from amaranth.hdl import Const, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath.rk4 import RK4

STAGE_BITS = max(1, (RK4.stages - 1).bit_length())


class Sequencer(wiring.Component):
    """Issues rows (one edge for every lane) and nodes in the order of their lists, each as soon as it may.

    A row of a stage may go when its nodes have been updated in the stage before; a node may go when all its edges have
    been summed in its own stage. Rows and nodes go in the order of their lists, stage after stage, so that two counters
    are all the synchronisation there is. A node's update needs only rows of its own stage, and a row only updates of
    the stage before: any order of the lists comes to its end. How far each of them has come in its stage is counted
    outside (`hw.machine.completion_counter`); here it is known which stage that is.

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
        The steps are counted a cycle late.
    row_valid, row_goes, row_last, row_nodes : In(1)
        A row stands in its `hw.machine.issue_register`; it goes in this cycle; it is its list's last; all its
        nodes have been updated in the stage that the updates are in.
    row_behind_nodes : In(1)
        The same of the row behind the front.
    row_ready, row_behind_ready : Out(1)
        The row in front is ready to go in the next cycle; the one behind would be, if the one in front went now.
    row_stage : Out
        Of the row in front.
    node_valid, node_goes, node_last, node_rows : In(1)
        A node stands in front; it goes in this cycle; it is its list's last; all its rows have been summed in the stage
        that the sums are in.
    node_behind_last, node_behind_rows : In(1), node_ready, node_behind_ready : Out(1)
    node_stage : Out
    row_summed_last : In(1)
        The forces of a list's last row may be read.
    node_updated_last : In(1)
        The new state of a list's last node has been written.
    node_waits, list_waits, end_waits : Out(1)
        Why no row goes in this cycle of the run: the one in front waits for its nodes, there is none yet, or the last
        has gone.
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
                "row_valid": In(1),
                "row_goes": In(1),
                "row_last": In(1),
                "row_nodes": In(1),
                "row_behind_nodes": In(1),
                "row_ready": Out(1),
                "row_behind_ready": Out(1),
                "row_stage": Out(STAGE_BITS),
                "node_waits": Out(1),
                "list_waits": Out(1),
                "end_waits": Out(1),
                "node_valid": In(1),
                "node_goes": In(1),
                "node_last": In(1),
                "node_rows": In(1),
                "node_behind_last": In(1),
                "node_behind_rows": In(1),
                "node_ready": Out(1),
                "node_behind_ready": Out(1),
                "node_stage": Out(STAGE_BITS),
                "row_summed_last": In(1),
                "node_updated_last": In(1),
            }
        )

    def elaborate(self, platform):
        m = Module()
        last_stage = RK4.stages - 1
        # What the start of a run sets needs no reset: before it no row and no node goes
        rows_over, nodes_over = Signal(reset_less=True), Signal(reset_less=True)
        last_step = {name: Signal(name=f"{name}_last_step", reset_less=True) for name in ("row", "node", "update")}
        row_lead = Signal(2, reset_less=True)  # stages that the front row is ahead of the updates
        sum_lead = Signal(2, reset_less=True)  # stages that the sums are ahead of the front node
        row_stage, node_stage, update_stage = stages = [
            Signal(STAGE_BITS, name=f"stage_of_{name}", reset_less=True) for name in ("rows", "nodes", "updates")
        ]
        m.d.comb += [self.row_stage.eq(row_stage), self.node_stage.eq(node_stage)]

        # Behind a list's last entry comes its first, of the next stage
        row_turns, node_turns = self.row_valid & self.row_last, self.node_valid & self.node_last
        rows_end = rows_over | row_turns & (row_stage == last_stage) & last_step["row"]
        nodes_end = nodes_over | node_turns & (node_stage == last_stage) & last_step["node"]
        far = (row_lead == 1) & ~row_turns | (row_lead == 0) & row_turns
        near = self.node_behind_rows & ~self.node_behind_last
        node_ready = ~nodes_over & ((sum_lead != 0) | self.node_rows & ~self.node_last)
        node_behind_ready = ~nodes_end & ((sum_lead > node_turns) | (sum_lead == node_turns) & near)
        if self._cycles_per_node > 1:  # it has its turns to wait for
            node_ready, node_behind_ready = node_ready & self._rested(m), Const(0)
        m.d.comb += [
            self.row_ready.eq(~rows_over & ((row_lead == 0) | (row_lead == 1) & self.row_nodes)),
            self.row_behind_ready.eq(~rows_end & ((row_lead == 0) & ~row_turns | far & self.row_behind_nodes)),
            self.node_ready.eq(node_ready),
            self.node_behind_ready.eq(node_behind_ready),
            self.node_waits.eq(self.busy & ~rows_over & self.row_valid & ~self.row_goes),
            self.list_waits.eq(self.busy & ~rows_over & ~self.row_valid),
            self.end_waits.eq(self.busy & rows_over),
        ]

        # The rows' stage goes up with the list's last row, the updates' stage with the list's last node
        row_stage_done, sum_stage_done = Signal(), self.row_summed_last
        node_stage_done, update_stage_done = Signal(), self.node_updated_last
        m.d.comb += [
            row_stage_done.eq(self.row_goes & self.row_last),
            node_stage_done.eq(self.node_goes & self.node_last),
        ]
        m.d.sync += [
            row_lead.eq(row_lead + row_stage_done - update_stage_done),
            sum_lead.eq(sum_lead + sum_stage_done - node_stage_done),
        ]
        # While the updates are in a step's first stage, rows and nodes are in the same step, none of them near its end
        stopping, stops = Signal(), Signal()
        m.d.comb += stops.eq(stopping & (update_stage == 0))
        with m.If(self.stop):
            m.d.sync += stopping.eq(1)

        # A step's last stage is over, of its rows, nodes and updates. The steps are counted a cycle later: each is
        # longer than the cycles that it takes to see which is the last
        for name, stage, done in (
            ("row", row_stage, row_stage_done),
            ("node", node_stage, node_stage_done),
            ("update", update_stage, update_stage_done),
        ):
            turn, turned = Signal(name=f"{name}_turn"), Signal(name=f"{name}_turned")
            left = Signal(len(self.steps), name=f"{name}_steps_left", reset_less=True)
            m.d.comb += turn.eq(done & (stage == last_stage))
            m.d.sync += [turned.eq(turn), last_step[name].eq(left == 1)]
            with m.If(done):
                m.d.sync += stage.eq(Mux(turn, 0, stage + 1))
            with m.If(turned):
                m.d.sync += left.eq(left - 1)
            with m.If(stops):
                m.d.sync += left.eq(1)
            if name == "update":
                m.d.sync += self.steps_done.eq(self.steps_done + turned)
            with m.If(self.start):
                m.d.sync += [turned.eq(0), left.eq(self.steps)]
            with m.If(turn & last_step[name]):
                m.d.sync += {"row": rows_over.eq(1), "node": nodes_over.eq(1), "update": self.busy.eq(0)}[name]

        with m.If(self.start):
            m.d.sync += [signal.eq(0) for signal in (*stages, row_lead, sum_lead, rows_over, nodes_over)]
            m.d.sync += [stopping.eq(0), self.busy.eq(1), self.steps_done.eq(0)]
        return m

    def _rested(self, m):
        """Whether a node that is ready now goes when the one before has had its turns."""
        rest = Signal(range(self._cycles_per_node))
        with m.If(self.node_goes):
            m.d.sync += rest.eq(self._cycles_per_node - 2)
        with m.Elif(rest != 0):
            m.d.sync += rest.eq(rest - 1)
        return rest == 0
