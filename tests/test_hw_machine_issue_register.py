"""The front of a list: entries in their order, each found ready, in front or behind it, before it may go."""

import pytest
from hw_objects import simulate

from hw.machine.issue_register import LATENCY, IssueRegister


@pytest.mark.parametrize(("there", "ready"), [(1.0, 1.0), (0.5, 1.0), (1.0, 0.3), (0.6, 0.5)])
def test_entries_go_in_order_and_only_when_ready(there, ready, rng):
    dut, taken, found, cycles = IssueRegister(width=8), [], set(), 400

    async def bench(ctx):
        number = 0  # of the entry behind
        ctx.set(dut.flush, 1)
        await ctx.tick()
        ctx.set(dut.flush, 0)
        for _ in range(cycles):
            valid, front = ctx.get(dut.valid), ctx.get(dut.entry)
            behind, ready_behind, ready_front = (bool(rng.random() < share) for share in (there, ready, ready))
            ctx.set(dut.behind, number % 256)
            ctx.set(dut.behind_valid, behind)
            ctx.set(dut.behind_ready, ready_behind)
            ctx.set(dut.ready, ready_front)
            take = bool(ctx.get(dut.goes))
            assert take <= valid
            if take:
                assert len(taken) in found and front == len(taken) % 256
                taken.append(front)
            elif valid and ready_front:
                found.add(len(taken))
            assert ctx.get(dut.moves) == (take or not valid)
            moved = behind and ctx.get(dut.moves)
            if moved and ready_behind:
                found.add(number)
            number += moved
            await ctx.tick()

    simulate(dut, bench)
    assert len(taken) > cycles / 10
    assert (there < 1 or ready < 1) or len(taken) == cycles - LATENCY


def test_a_flush_empties_it():
    dut = IssueRegister(width=8)

    async def bench(ctx):
        ctx.set(dut.behind_valid, 1)
        ctx.set(dut.behind_ready, 1)
        await ctx.tick()
        assert ctx.get(dut.valid) and ctx.get(dut.goes)
        ctx.set(dut.flush, 1)
        await ctx.tick()
        assert not ctx.get(dut.valid) and not ctx.get(dut.goes)

    simulate(dut, bench)
