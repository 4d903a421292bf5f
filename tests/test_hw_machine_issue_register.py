"""The issue register: entries in their order, each found ready before it is issued, in the register or before it."""

import pytest
from hw_objects import simulate

from hw.machine.issue_register import LATENCY, IssueRegister


@pytest.mark.parametrize(("there", "ready"), [(1.0, 1.0), (0.5, 1.0), (1.0, 0.3), (0.6, 0.5)])
def test_entries_go_in_order_and_only_when_ready(there, ready, rng):
    dut, taken, found, cycles = IssueRegister(width=8), [], set(), 400

    async def bench(ctx):
        number = 0  # of the entry that is fetched
        ctx.set(dut.flush, 1)
        await ctx.tick()
        ctx.set(dut.flush, 0)
        for _ in range(cycles):
            valid, entry = ctx.get(dut.valid), ctx.get(dut.entry)
            fetched, next_ready, entry_ready = (bool(rng.random() < share) for share in (there, ready, ready))
            ctx.set(dut.next, number % 256)
            ctx.set(dut.advance.next_valid, fetched)
            ctx.set(dut.advance.next_ready, next_ready)
            ctx.set(dut.advance.ready, entry_ready)
            take = bool(ctx.get(dut.issue))
            assert take <= valid
            if take:
                assert len(taken) in found and entry == len(taken) % 256
                taken.append(entry)
            elif valid and entry_ready:
                found.add(len(taken))
            assert ctx.get(dut.advances) == (take or not valid)
            moved = fetched and ctx.get(dut.advances)
            if moved and next_ready:
                found.add(number)
            number += moved
            await ctx.tick()

    simulate(dut, bench)
    assert len(taken) > cycles / 10
    assert (there < 1 or ready < 1) or len(taken) == cycles - LATENCY


def test_a_flush_empties_it():
    dut = IssueRegister(width=8)

    async def bench(ctx):
        ctx.set(dut.advance.next_valid, 1)
        ctx.set(dut.advance.next_ready, 1)
        await ctx.tick()
        assert ctx.get(dut.valid) and ctx.get(dut.issue)
        ctx.set(dut.flush, 1)
        await ctx.tick()
        assert not ctx.get(dut.valid) and not ctx.get(dut.issue)

    simulate(dut, bench)
