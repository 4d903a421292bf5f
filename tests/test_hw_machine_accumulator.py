"""The accumulator: a force per cycle on any nodes in any order, and every sum is exact."""

import numpy as np
import pytest
from hw_objects import simulate

from golden.datapath.formats import Formats
from golden.numbers.graph import AXES
from hw.machine.accumulator import ANNOUNCED, READ, WRITTEN, Accumulator
from hw.machine.interfaces import named

FORMATS = Formats()
NODES = 8
FORCE = FORMATS.force

ORDERS = {
    "the same node in every cycle": lambda rng, count: np.zeros(count, int),
    "two nodes in turn": lambda rng, count: np.arange(count) % 2,
    "three nodes in turn": lambda rng, count: np.arange(count) % 3,
    "four nodes in turn": lambda rng, count: np.arange(count) % 4,
    "five nodes in turn": lambda rng, count: np.arange(count) % 5,
    "any order": lambda rng, count: rng.integers(NODES, size=count),
    "few nodes in any order": lambda rng, count: rng.integers(3, size=count),
}


def accumulate(dut, nodes, first, pulls, gaps, noise):
    """Announce and give the forces, then read all sums: (NODES, 3). Unused inputs carry noise."""
    starts = (np.cumsum(gaps) + np.arange(len(nodes))).tolist()
    announced = dict(zip(starts, range(len(nodes)), strict=True))
    sums, pull, total = [], named(dut.pull), named(dut.sums[0])

    async def bench(ctx):
        for cycle in range(starts[-1] + 1 + ANNOUNCED + WRITTEN):
            item, arrived = announced.get(cycle), announced.get(cycle - ANNOUNCED)
            ctx.set(dut.valid, item is not None)
            ctx.set(dut.node, int(noise.integers(NODES) if item is None else nodes[item]))
            ctx.set(dut.first, int(noise.integers(2) if item is None else first[item]))
            for axis, name in enumerate(AXES):
                force = noise.integers(FORCE.raw_min, FORCE.raw_max) if arrived is None else pulls[arrived, axis]
                ctx.set(pull[name], int(force))
            if cycle >= starts[-1] + ANNOUNCED + WRITTEN:
                ctx.set(dut.valid, 0)
                break
            await ctx.tick()
        for node in [*range(NODES), *[0] * READ]:
            sums.append([ctx.get(total[axis]) for axis in AXES])
            ctx.set(dut.sum_row, node)
            await ctx.tick()

    simulate(dut, bench)
    return np.array(sums[READ:])


def model(nodes, first, pulls, sign):
    sums = np.zeros((NODES, 3), np.int64)
    for node, new, pull in zip(nodes, first, pulls, strict=True):
        sums[node] = (0 if new else sums[node]) + sign * pull
    return sums


@pytest.mark.parametrize("subtract", [False, True], ids=["first ends", "second ends"])
@pytest.mark.parametrize("widest_gap", [0, 1, 3])
@pytest.mark.parametrize("order", ORDERS)
def test_sums_are_exact(order, widest_gap, subtract, rng):
    count = 120
    nodes = ORDERS[order](rng, count)
    pulls = rng.integers(FORCE.raw_min, FORCE.raw_max, (count, 3), endpoint=True) >> rng.integers(0, 30, (count, 1))
    first = rng.random(count) < 0.1
    first[[np.flatnonzero(nodes == node)[0] for node in set(nodes)]] = True
    gaps = rng.integers(0, widest_gap, count, endpoint=True)
    dut = Accumulator(formats=FORMATS, nodes=NODES, subtract=subtract)
    sums = accumulate(dut, nodes, first, pulls, gaps, rng)
    expected = model(nodes, first, pulls, -1 if subtract else 1)
    touched = sorted(set(nodes))
    assert np.array_equal(sums[touched], expected[touched])


@pytest.mark.parametrize("distance", range(1, 8))
def test_a_sum_is_forwarded_over_every_distance(distance, rng):
    """Forces on node 0, ``distance`` cycles apart, with others or nothing in between."""
    rounds = 12
    for between in (True, False):
        if between:
            nodes = np.where(np.arange(rounds * distance) % distance, rng.integers(1, NODES, rounds * distance), 0)
            gaps = np.zeros(len(nodes), int)
        else:
            nodes, gaps = np.zeros(rounds, int), np.full(rounds, distance - 1)
        first = np.arange(len(nodes)) == 0
        pulls = rng.integers(-1000, 1000, (len(nodes), 3))
        dut = Accumulator(formats=FORMATS, nodes=NODES)
        sums = accumulate(dut, nodes, first, pulls, gaps, rng)
        assert np.array_equal(sums[0], pulls[nodes == 0].sum(0))


def test_a_sum_can_be_read_after_its_latency(rng):
    """`WRITTEN` cycles after its force, while forces on other nodes go on."""
    dut, seen = Accumulator(formats=FORMATS, nodes=NODES), []
    pulls = rng.integers(-1000, 1000, 40).tolist()

    async def bench(ctx):
        for cycle, _ in enumerate(pulls):
            ctx.set(dut.valid, 1)
            ctx.set(dut.first, 1)
            ctx.set(dut.node, cycle % NODES)
            if cycle >= ANNOUNCED:
                ctx.set(dut.pull.x, pulls[cycle - ANNOUNCED])
            ctx.set(dut.sum_row, (cycle - ANNOUNCED - WRITTEN) % NODES)
            if cycle >= ANNOUNCED + READ + WRITTEN:
                seen.append(ctx.get(dut.sums[0].x))
            await ctx.tick()

    simulate(dut, bench)
    assert seen == pulls[: len(seen)] and len(seen) > 30


def test_as_many_of_the_largest_forces_as_a_node_may_have_edges():
    count = 1 << FORMATS.degree_bits
    for sign, extreme in ((1, FORCE.raw_min), (-1, FORCE.raw_max)):
        dut = Accumulator(formats=FORMATS, nodes=NODES, subtract=sign < 0)
        pulls = np.full((count, 3), extreme)
        first = np.arange(count) == 0
        sums = accumulate(dut, np.zeros(count, int), first, pulls, np.zeros(count, int), np.random.default_rng(0))
        assert (sums[0] == sign * extreme * count).all()
