"""The highest of several numbers, in every cycle."""

import pytest
from hw_objects import simulate

from hw.blocks.highest import Highest, latency

WIDTH = 5


@pytest.mark.parametrize("count", [1, 2, 3, 8, 12])
def test_the_highest_of_the_valid_ones(count, rng):
    dut, expected, seen = Highest(count=count, width=WIDTH), [], []

    async def bench(ctx):
        for _ in range(200):
            numbers = rng.integers(1 << WIDTH, size=count).tolist()
            valid = (rng.random(count) < 0.6).tolist()
            ctx.set(dut.numbers, sum(number << n * WIDTH for n, number in enumerate(numbers)))
            ctx.set(dut.valid, sum(bit << n for n, bit in enumerate(valid)))
            expected.append(max((number for number, bit in zip(numbers, valid, strict=True) if bit), default=0))
            seen.append(ctx.get(dut.highest))
            await ctx.tick()

    simulate(dut, bench)
    assert seen[latency(count) :] == expected[: -latency(count)]
