"""How far a list has come: what is reached is known in the cycle in which it is done, and forgotten with its last."""

import pytest
from hw_objects import simulate

from hw.machine.completion_counter import CompletionCounter


@pytest.mark.parametrize(("first", "length"), [(0, 1), (0, 2), (0, 8), (1, 1), (1, 2), (1, 7)])
def test_what_is_reached_is_what_is_less_than_the_count(first, length, rng):
    """The last entry is done as often as any: with it the next list begins. The longest list fills the count."""
    dut, seen, needs = CompletionCounter(width=3, first=first), set(), min(8, length + first + 1)

    async def bench(ctx):
        count, (front, behind, after) = first, rng.integers(needs, size=3)
        for cycle in range(600):
            clear = cycle == 0 or rng.random() < 0.02
            moves, done = rng.random(2) < (0.5, 0.6) if not clear else (0, 0)
            last = count - first == length - 1
            for port, value in (
                ("front", front),
                ("behind", behind),
                ("after", after),
                ("moves", moves),
                ("done", done),
                ("done_last", last),
                ("clear", clear),
            ):
                ctx.set(getattr(dut, port), int(value))
            await ctx.tick()
            if clear:  # at the start of a run nothing stands in front: a cycle later all has been compared
                count = first
                ctx.set(dut.clear, 0)
                await ctx.tick()
            elif done:
                count = first if last else count + 1
            front, behind = (behind, after) if moves else (front, behind)
            after = rng.integers(needs)
            expected = front < count, behind < count
            seen.add(expected)
            assert (ctx.get(dut.front_reached), ctx.get(dut.behind_reached)) == expected, (front, behind, count)

    simulate(dut, bench)
    assert (True, True) in seen or length + first == 1
    assert (False, False) in seen
