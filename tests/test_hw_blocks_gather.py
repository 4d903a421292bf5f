"""The OR of a group of words is out beside each of them."""

import functools
import operator

from hw_objects import simulate

from hw.blocks.gather import GATHERED, Gather

WIDTH = 5


def test_the_bits_of_a_group_come_beside_each_of_its_words(rng):
    """Groups back to back, and with noise between them."""
    dut, expected, seen = Gather(width=WIDTH), {}, []

    async def bench(ctx):
        async def cycle(word, first):
            ctx.set(dut.i, word)
            ctx.set(dut.first, first)
            seen.append(ctx.get(dut.o))
            await ctx.tick()

        for _ in range(60):
            words = (rng.integers(1 << WIDTH, size=GATHERED) & rng.integers(1 << WIDTH, size=GATHERED)).tolist()
            for number, word in enumerate(words):
                expected[len(seen) + GATHERED] = functools.reduce(operator.or_, words)
                await cycle(word, number == 0)
            for _ in range(rng.integers(0, 4)):
                await cycle(int(rng.integers(1 << WIDTH)), 0)
        for _ in range(GATHERED):
            await cycle(0, 0)

    simulate(dut, bench)
    assert len(expected) == 60 * GATHERED and len(set(expected.values())) > 8
    assert {cycle: seen[cycle] for cycle in expected} == expected
