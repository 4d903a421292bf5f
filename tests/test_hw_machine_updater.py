"""The node updaters compute the integers of `golden.datapath.node`, whole steps on random nodes, and the host reads
them."""

from collections import Counter

import numpy as np
import pytest
from datapath_calls import call_node
from hw_objects import simulate
from integer_objects import random_raw, random_record

from golden.datapath import records
from golden.datapath.rk4 import RK4
from golden.numbers.graph import AXES
from golden.numbers.qarray import QArray
from golden.numbers.qformat import BIT
from hw.blocks.memory import READ_LATENCY
from hw.machine.accumulator import READ
from hw.machine.core import datapaths
from hw.machine.interfaces import named
from hw.machine.node_copies import NODE_WORDS
from hw.machine.node_pipeline import banks
from hw.machine.routes import HANDOVER
from hw.machine.serial_updater import SerialNodeUpdater
from hw.machine.updater import NodeUpdater
from hw.parameters import Parameters

NODES, STEPS, SHIFT = 12, 2, 5
VECTORS = ("x_base", "v_base", "v", "x_total", "v_total")


class Nodes:
    """The nodes in integers."""

    def __init__(self, fmt, rng, banks):
        self.fmt, self.banks, self.faults = fmt, banks, Counter()
        self.vectors = {name: random_raw(rng, q, (NODES, 3)) for name, q in records.node_state(fmt).items()}
        self.vectors["v"] = self.vectors["v_base"].copy()  # as the host writes it
        self.load = random_raw(rng, fmt.accumulator, (NODES, 3))
        self.mass = random_record(rng, records.inverse_mass(fmt), NODES)
        self.mass["shift"] = rng.integers(-3, 12, NODES)
        self.force = np.zeros((NODES, 3), np.int64)
        self.x = self.vectors["x_base"]

    def update(self, stage: int, sums, mask):
        """``sums``: (banks, NODES, 3), ``mask``: (NODES, banks)."""
        q = {**records.node_state(self.fmt), "load": self.fmt.accumulator}
        vectors = self.vectors | {"load": self.load}
        raw = {f"{name}_{a}": (v[:, k], q[name]) for name, v in vectors.items() for k, a in enumerate(AXES)}
        for bank in range(self.banks):
            shown = np.where(mask[:, bank, None], sums[bank], 0)
            raw |= {f"pull{bank}_{a}": (shown[:, k], self.fmt.accumulator) for k, a in enumerate(AXES)}
        mass = records.inverse_mass(self.fmt)
        raw |= {f"inverse_mass_{name}": (self.mass[name], mass[name]) for name in mass}
        raw |= {f"stage_{bit}": (np.int64(value), BIT) for bit, value in RK4.stage(stage).items()}
        raw["velocity_shift"] = np.int64(SHIFT), self.fmt.exponent
        numbers = {name: QArray(np.ascontiguousarray(values), fmt, self.faults) for name, (values, fmt) in raw.items()}
        results = call_node(self.fmt, self.banks, numbers)
        after = {
            name: np.stack([c.raw for c in results[name]], 1)
            for name in ("x", "v", "force", "x_base_next", "v_base_next", "x_total", "v_total")
        }
        self.x, self.force = after["x"], after["force"]
        self.vectors = {name: after.get(f"{name}_next", after.get(name)) for name in VECTORS}


class Bench:
    def __init__(self, dut, nodes, rng, order, widest_gap):
        self.dut, self.nodes, self.rng, self.order, self.widest_gap = dut, nodes, rng, order, widest_gap
        self.faults = set()

    def set_axis(self, ctx, axis: str):
        if self.dut.datapath.cycles_per_node > 1 and axis in AXES:
            ctx.set(self.dut.host.axis, AXES.index(axis))

    async def write(self, ctx, strobe, bit, values):
        ctx.set(self.dut.host.active, 1)
        self.set_axis(ctx, AXES[bit % 3])
        for index, value in enumerate(values):
            ctx.set(strobe, 1 << bit)
            ctx.set(self.dut.host.index, index)
            ctx.set(self.dut.host.data, int(value))
            await ctx.tick()
        ctx.set(strobe, 0)
        await ctx.tick().repeat(HANDOVER)

    async def load(self, ctx):
        dut, nodes = self.dut, self.nodes
        for bit, word in enumerate(NODE_WORDS):
            quantity, axis = word.split("_")
            await self.write(ctx, dut.host.write.state, bit, nodes.vectors[f"{quantity}_base"][:, AXES.index(axis)])
        for bit in range(3):
            await self.write(ctx, dut.host.write.load, bit, nodes.load[:, bit])
        mass = records.inverse_mass(nodes.fmt)
        packed = [mass.pack({name: nodes.mass[name][n] for name in mass}) for n in range(NODES)]
        await self.write(ctx, dut.host.write.mass, 0, packed)
        ctx.set(dut.host.active, 0)
        await ctx.tick().repeat(HANDOVER)
        return packed

    async def stage(self, ctx, number):
        """Issue all nodes in the order, and check each when its new state comes out."""
        dut, rng, fmt = self.dut, self.rng, self.nodes.fmt
        sums = random_raw(rng, fmt.accumulator, (self.nodes.banks, NODES, 3))
        mask = rng.integers(2, size=(NODES, self.nodes.banks))
        self.nodes.update(number, sums, mask)
        gaps = rng.integers(0, self.widest_gap, NODES, endpoint=True)
        cycles = np.cumsum(gaps) + dut.datapath.cycles_per_node * np.arange(NODES)
        issued = dict(zip(cycles.tolist(), self.order.tolist(), strict=True))
        for bit, value in RK4.stage(number).items():
            ctx.set(named(dut.stage)[bit], value)
        totals, update = banks(dut.sums), named(dut.update)
        for cycle in range(max(issued) + dut.datapath.latency + 2):
            node, summed, done = issued.get(cycle), issued.get(cycle - READ), issued.get(cycle - dut.datapath.latency)
            ctx.set(dut.valid, node is not None)
            if node is not None:
                ctx.set(dut.row, node)
                ctx.set(dut.mask, sum(int(bit) << bank for bank, bit in enumerate(mask[node])))
            if summed is not None:
                for bank in range(self.nodes.banks):
                    for k, axis in enumerate(AXES):
                        ctx.set(totals[bank][axis], int(sums[bank, summed, k]))
            assert ctx.get(dut.update.strobe) == (done is not None)
            if done is not None:
                assert ctx.get(dut.update_row) == done
                for word in NODE_WORDS:
                    expected = self.nodes.x if word[0] == "x" else self.nodes.vectors["v"]
                    assert ctx.get(update[word]) == expected[done, AXES.index(word[2])], word
            bits = ctx.get(dut.fault)
            self.faults |= {name for bit, name in enumerate(dut.datapath.faults) if bits >> bit & 1}
            await ctx.tick()

    async def read(self, ctx, port, axis=""):
        seen = []
        ctx.set(self.dut.host.active, 1)
        self.set_axis(ctx, axis)
        for index in [*range(NODES), *[0] * (HANDOVER + READ_LATENCY)]:
            seen.append(ctx.get(port))
            ctx.set(self.dut.host.index, index)
            await ctx.tick()
        ctx.set(self.dut.host.active, 0)
        await ctx.tick().repeat(HANDOVER)
        return seen[HANDOVER + READ_LATENCY :]


def updater(parameters):
    make = NodeUpdater if parameters.axes == 3 else SerialNodeUpdater
    return make(parameters, datapaths(parameters)[1])


@pytest.mark.parametrize(
    ("axes", "lanes", "order", "widest_gap"),
    [
        (3, 1, "up", 0),
        (3, 2, "any", 2),
        (1, 1, "up", 0),
        (1, 2, "any", 2),
        (1, 1, "any", 5),
    ],
)
def test_whole_steps(axes, lanes, order, widest_gap, rng):
    parameters = Parameters(lanes=lanes, nodes=NODES, edges=8, materials=2, tables=1, axes=axes)
    dut, nodes = updater(parameters), Nodes(parameters.formats, rng, 2 * lanes)
    assert dut.datapath.banks == nodes.banks
    orders = {"up": np.arange(NODES), "any": rng.permutation(NODES)}
    run = Bench(dut, nodes, rng, orders[order], widest_gap)
    state, words = 1 << parameters.formats.state, named(dut.host.words)

    async def bench(ctx):
        ctx.set(dut.velocity_shift, SHIFT)
        packed = await run.load(ctx)
        for step in range(STEPS):
            for stage in range(RK4.stages):
                await run.stage(ctx, stage)
            for k, axis in enumerate(AXES):
                for word, values in (
                    (f"state_x_{axis}", nodes.x),
                    (f"state_v_{axis}", nodes.vectors["v"]),
                    (f"force_{axis}", nodes.force),
                    (f"load_{axis}", nodes.load),
                ):
                    assert await run.read(ctx, words[word], axis) == (values[:, k] % state).tolist(), (step, word)
            assert await run.read(ctx, dut.host.words.mass) == packed

    simulate(dut, bench)
    assert run.faults == set(nodes.faults) and len(run.faults) >= 3


@pytest.mark.parametrize("axes", [1, 3])
def test_a_word_the_host_writes_is_where_the_next_step_starts(axes, rng):
    """Positions and velocities between two steps: both the start and the value of the first stage."""
    parameters = Parameters(lanes=1, nodes=NODES, edges=8, materials=2, tables=1, axes=axes)
    dut, nodes = updater(parameters), Nodes(parameters.formats, rng, 2)
    run = Bench(dut, nodes, rng, np.arange(NODES), 1)

    async def bench(ctx):
        ctx.set(dut.velocity_shift, SHIFT)
        await run.load(ctx)
        for _ in range(2):
            for stage in range(RK4.stages):
                await run.stage(ctx, stage)
            fresh = Nodes(nodes.fmt, rng, 2)
            nodes.vectors |= {name: fresh.vectors[name] for name in ("x_base", "v_base", "v")}
            nodes.load, nodes.mass, nodes.x = fresh.load, fresh.mass, fresh.x
            await run.load(ctx)
        await run.stage(ctx, 0)

    simulate(dut, bench)
