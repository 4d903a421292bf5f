"""The sequencer: no row before its nodes, no node before its rows, and every list comes to its end."""

from dataclasses import dataclass, field

import numpy as np
import pytest
from hw_objects import simulate

from golden.datapath.rk4 import RK4
from hw.machine.sequencer import Sequencer


@dataclass
class Lists:
    """Rows as sets of nodes; ``need[n]``: rows to be summed before node n; ``told[n]``: what the circuit is told."""

    rows: list[set]
    nodes: int
    told: list[int] = field(default_factory=list)

    def __post_init__(self):
        self.need = [max((k + 1 for k, row in enumerate(self.rows) if n in row), default=0) for n in range(self.nodes)]
        self.told = self.told or self.need


def random_lists(rng, nodes, rows, lanes, kind) -> Lists:
    """``sorted``: as a good host orders them; ``shuffled``: any order; ``backwards``: the worst; ``empty``: hardly an
    edge, most of the nodes alone."""
    if kind == "empty":
        return Lists([set(rng.choice(nodes, 2).tolist()) if k == 0 else set() for k in range(rows)], nodes)
    spread = nodes if kind == "shuffled" else 4
    ends = rng.integers(nodes, size=(rows * lanes, 1)) + rng.integers(-spread, spread + 1, (rows * lanes, 2))
    ends = np.clip(ends, 0, nodes - 1)
    if kind != "shuffled":
        ends = ends[np.argsort(ends.max(1))]
    if kind == "backwards":
        ends = ends[::-1]
    return Lists([set(row.ravel().tolist()) for row in ends.reshape(rows, -1)], nodes)


class Run:
    """A sequencer between lists and pipelines of given lengths, watched in every cycle."""

    def __init__(self, dut, lists: Lists, steps, latencies, ready, rng, stop=None, cycles_per_node=1):
        self._stop = stop  # the cycle in which it is told to stop
        self._pace, self._last_node = cycles_per_node, -cycles_per_node  # the cycle in which a node went
        self.dut, self.lists, self.steps = dut, lists, steps
        self.row_latency, self.node_latency = latencies
        self._ready, self._rng = ready, rng
        self.rows_taken = self.nodes_taken = 0
        # A row, a node in its `hw.machine.issue_register.IssueRegister`
        self._waiting, self._issues = [False, False], [False, False]
        self.rows_summed = self.nodes_updated = 0  # over all stages, before this cycle
        self.cycles = self.waits = 0

    async def bench(self, ctx):
        dut, lists = self.dut, self.lists
        ctx.set(dut.steps, self.steps)
        ctx.set(dut.start, 1)
        await ctx.tick()
        ctx.set(dut.start, 0)
        row_line, node_line = [(False, False)] * self.row_latency, [(False, False)] * self.node_latency
        loop = self.row_latency + self.node_latency + 8
        limit = RK4.stages * self.steps * (len(lists.rows) + lists.nodes) * loop
        while ctx.get(dut.busy):
            if self.cycles == self._stop:
                self.steps = min(self.steps, self.nodes_updated // (RK4.stages * lists.nodes) + 2)
            ctx.set(dut.stop, self.cycles == self._stop)
            taken = self._cycle(ctx, row_line[0], node_line[0])
            row_line, node_line = [*row_line[1:], taken[0]], [*node_line[1:], taken[1]]
            self.cycles += 1
            assert self.cycles < limit, "the lists don't come to their end"
            await ctx.tick()
        ctx.set(dut.stop, 0)
        await ctx.tick()
        if self._stop is not None:
            assert ctx.get(dut.steps_done) in (self.steps, self.steps - 1)
            self.steps = ctx.get(dut.steps_done)
        stages = RK4.stages * self.steps
        assert (self.rows_taken, self.nodes_taken) == (stages * len(lists.rows), stages * lists.nodes)
        assert (self.rows_summed, self.nodes_updated) == (self.rows_taken, self.nodes_taken)
        for _ in range(3):  # it stays so
            assert ctx.get(dut.steps_done) == self.steps
            ready = dut.row.ready, dut.row.next_ready, dut.node.ready, dut.node.next_ready
            assert not ctx.get(dut.busy) and not any(map(ctx.get, ready))
            await ctx.tick()

    def _cycle(self, ctx, summed, updated):
        dut, lists = self.dut, self.lists
        row_stage, row = divmod(self.rows_taken, len(lists.rows))
        node_stage, node = divmod(self.nodes_taken, lists.nodes)
        row_valid, node_valid = self._waiting
        following = ((row + row_valid) % len(lists.rows), (node + node_valid) % lists.nodes)
        (summed, sums_last), (updated, updates_last) = summed, updated
        ctx.set(dut.rows_done, sums_last)
        ctx.set(dut.nodes_done, updates_last)
        ctx.set(dut.row.valid, row_valid)
        ctx.set(dut.row.issue, self._issues[0])
        ctx.set(dut.row.last, row == len(lists.rows) - 1)
        # As `hw.machine.completion_counter` counts them: in the stage that the updates, or the sums, are in
        in_stage = self.nodes_updated % lists.nodes
        ctx.set(dut.row.reached, all(n < in_stage for n in lists.rows[row]))
        ctx.set(dut.row.next_reached, all(n < in_stage for n in lists.rows[following[0]]))
        ctx.set(dut.node.valid, node_valid)
        ctx.set(dut.node.issue, self._issues[1])
        ctx.set(dut.node.last, node == lists.nodes - 1)
        in_stage = self.rows_summed % len(lists.rows)
        ctx.set(dut.node.reached, lists.told[node] <= in_stage)
        ctx.set(dut.node.next_last, following[1] == lists.nodes - 1)
        ctx.set(dut.node.next_reached, lists.told[following[1]] <= in_stage)
        row_take, node_take = self._issues
        if row_take:
            assert row_stage < RK4.stages * self.steps
            assert ctx.get(dut.row_stage) == row_stage % RK4.stages
            last = min(max(lists.rows[row], default=-1), lists.nodes - 1)
            needed = lists.nodes * (row_stage - 1) + last + 1
            assert self.nodes_updated >= needed, "a row went before its nodes were updated"
        if node_take:
            assert node_stage < RK4.stages * self.steps
            assert ctx.get(dut.node_stage) == node_stage % RK4.stages
            needed = len(lists.rows) * node_stage + lists.need[node]
            assert self.rows_summed >= needed, "a node went before its rows were summed"
            assert self.cycles >= self._last_node + self._pace, "a node went before the one before had its cycles"
            self._last_node = self.cycles
        for k, (port, take) in enumerate(((dut.row, row_take), (dut.node, node_take))):
            if take or not self._waiting[k]:
                self._waiting[k] = bool(self._rng.random() < self._ready)
                self._issues[k] = self._waiting[k] and bool(ctx.get(port.next_ready))
            else:
                self._issues[k] |= bool(ctx.get(port.ready))
        waits = ctx.get(dut.node_waits)
        assert waits <= row_valid and not (waits and row_take)
        self.waits += waits
        self.rows_taken += row_take
        self.nodes_taken += node_take
        self.rows_summed += summed
        self.nodes_updated += updated
        lasts = row == len(lists.rows) - 1, node == lists.nodes - 1
        return tuple((bool(take), bool(take and last)) for take, last in zip((row_take, node_take), lasts, strict=True))


def watched(*runs):
    async def bench(ctx):
        for run in runs:
            await run.bench(ctx)

    simulate(runs[0].dut, bench)


@pytest.mark.parametrize("kind", ["sorted", "shuffled", "backwards", "empty"])
@pytest.mark.parametrize("ready", [1.0, 0.6])
@pytest.mark.parametrize("latencies", [(1, 1), (12, 5), (3, 20)], ids=str)
def test_random_lists(kind, ready, latencies, rng):
    dut, runs = Sequencer(), []
    for _ in range(4):  # one after the other, on the same circuit
        lists = random_lists(rng, int(rng.integers(2, 20)), int(rng.integers(1, 25)), int(rng.integers(1, 4)), kind)
        runs.append(Run(dut, lists, int(rng.integers(1, 4)), latencies, ready, rng))
    watched(*runs)


@pytest.mark.parametrize("kind", ["sorted", "shuffled", "backwards", "empty"])
@pytest.mark.parametrize("ready", [1.0, 0.6])
def test_nodes_have_their_cycles(kind, ready, rng):
    dut, runs = Sequencer(cycles_per_node=3), []
    for latencies in (1, 3), (12, 5), (3, 20):
        lists = random_lists(rng, int(rng.integers(2, 20)), int(rng.integers(1, 25)), int(rng.integers(1, 4)), kind)
        runs.append(Run(dut, lists, int(rng.integers(1, 4)), latencies, ready, rng, cycles_per_node=3))
    watched(*runs)


@pytest.mark.parametrize("kind", ["sorted", "backwards", "empty"])
@pytest.mark.parametrize("latencies", [(1, 1), (12, 5)], ids=str)
def test_a_run_that_is_stopped_ends_with_a_step_at_most_one_later(kind, latencies, rng):
    dut, runs = Sequencer(), []
    for _ in range(60):  # one after the other, on the same circuit
        lists = random_lists(rng, int(rng.integers(2, 6)), int(rng.integers(1, 6)), int(rng.integers(1, 4)), kind)
        runs.append(Run(dut, lists, 50, latencies, 1.0, rng, stop=int(rng.integers(0, 400))))
    watched(*runs)
    assert len({run.steps for run in runs}) >= 6


@pytest.mark.parametrize("nodes", [2, 32])
@pytest.mark.parametrize("rows", [1, 64])
def test_short_and_long_lists(nodes, rows, rng):
    lists = random_lists(rng, nodes, rows, 1, "sorted")
    watched(Run(Sequencer(), lists, 2, (5, 3), 1.0, rng))


def test_a_node_that_asks_for_more_rows_than_there_are_is_issued_after_the_last(rng):
    """With a host's mistake the run is slow, but it ends."""
    rows = random_lists(rng, 8, 10, 1, "sorted").rows
    watched(Run(Sequencer(), Lists(rows, 8, told=[40] * 8), 2, (5, 3), 1.0, rng))


def test_a_row_that_asks_for_a_node_beyond_the_list_is_issued_after_the_last(rng):
    rows = random_lists(rng, 8, 10, 1, "sorted").rows
    lists = Lists([row | {20} for row in rows], 8)
    watched(Run(Sequencer(), lists, 2, (5, 3), 1.0, rng))


def test_the_wavefront_overlaps_stages(rng):
    """A long sorted chain keeps the rows going: with barriers a stage would take rows + both latencies."""
    nodes, latencies = 32, (8, 4)
    rows = [{n, n + 1} for n in range(nodes - 1)]
    run = Run(Sequencer(), Lists(rows, nodes), 8, latencies, 1.0, rng)
    watched(run)
    stages = RK4.stages * run.steps
    assert run.cycles < stages * (nodes + 2) + sum(latencies) + 8
    assert run.waits < run.cycles / 8
