"""The completion counter: needs are met in the cycle in which an entry is done, and none after the list's last."""

import pytest
from hw_objects import simulate

from hw.machine.completion_counter import CompletionCounter


@pytest.mark.parametrize(("first", "length"), [(0, 1), (0, 2), (0, 8), (1, 1), (1, 2), (1, 7)])
def test_a_need_is_met_when_it_is_less_than_the_count(first, length, rng):
    """The last entry is done as often as any: with it the next list begins. The longest list fills the count."""
    dut, seen, needs = CompletionCounter(width=3, first=first), set(), min(8, length + first + 1)

    async def bench(ctx):
        count, (need, following, second) = first, rng.integers(needs, size=3)
        for cycle in range(600):
            clear = cycle == 0 or rng.random() < 0.02
            advances, done = rng.random(2) < (0.5, 0.6) if not clear else (0, 0)
            last = count - first == length - 1
            for port, value in (
                (dut.need, need),
                (dut.next_need, following),
                (dut.second_need, second),
                (dut.advances, advances),
                (dut.completion.done, done),
                (dut.completion.last, last),
                (dut.clear, clear),
            ):
                ctx.set(port, int(value))
            await ctx.tick()
            if clear:  # at the start of a run no entry is in the issue register: a cycle later all has been compared
                count = first
                ctx.set(dut.clear, 0)
                await ctx.tick()
            elif done:
                count = first if last else count + 1
            need, following = (following, second) if advances else (need, following)
            second = rng.integers(needs)
            expected = need < count, following < count
            seen.add(expected)
            assert (ctx.get(dut.reached), ctx.get(dut.next_reached)) == expected, (need, following, count)

    simulate(dut, bench)
    assert (True, True) in seen or length + first == 1
    assert (False, False) in seen
