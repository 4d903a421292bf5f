"""The pipelined multiplexer: one of many words, by an index that comes with them or earlier."""

import pytest
from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from hw_objects import refused, simulate

from hw.pipeline.choice import WAYS, choose
from hw.pipeline.delay import DelayLines

WIDTH = 9


class Choice(wiring.Component):
    def __init__(self, count, cycles, ahead):
        self._cycles, self._ahead = cycles, ahead
        words = {f"word{number}": In(WIDTH) for number in range(count)}
        super().__init__({"index": In(range(max(2, count))), **words, "o": Out(WIDTH)})
        self.words = [getattr(self, name) for name in words]

    def elaborate(self, platform):
        m = Module()
        lines = DelayLines(m)
        m.d.comb += self.o.eq(
            choose(m, lines, self.words, self.index, cycles=self._cycles, name="chosen", ahead=self._ahead)
        )
        lines.build()
        return m


@pytest.mark.parametrize("ahead", [0, 2])
@pytest.mark.parametrize(("count", "cycles"), [(1, 2), (2, 1), (3, 1), (4, 1), (5, 2), (14, 2), (16, 2), (22, 7)])
def test_a_choice_a_cycle(count, cycles, ahead, rng):
    dut, asked, expected, seen = Choice(count, cycles, ahead), [0] * ahead, [], []

    async def bench(ctx):
        for _ in range(100):
            words, index = rng.integers(0, 1 << WIDTH, count).tolist(), int(rng.integers(count))
            for port, word in zip(dut.words, words, strict=True):
                ctx.set(port, word)
            ctx.set(dut.index, index)
            asked.append(index)
            expected.append(words[asked.pop(0)])
            seen.append(ctx.get(dut.o))
            await ctx.tick()

    simulate(dut, bench)
    assert seen[cycles:] == expected[:-cycles]


def test_more_words_than_cycles_can_tell_apart_are_refused():
    words = [Signal(4) for _ in range(WAYS + 1)]
    refused(
        lambda: choose(Module(), None, words, Signal(3), cycles=1, name="chosen"),
        "words must be at most 4 to choose from in 1 cycles, not 5",
    )
