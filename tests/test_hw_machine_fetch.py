"""The fetch of a list: all entries in their order, over and over, none twice, whenever they are taken."""

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from hw_objects import simulate

from hw.blocks.memory import READ_LATENCY
from hw.machine.fetch import Fetch, PacedFetch, latency
from hw.machine.issue_register import IssueRegister

BITS = 6


def word(index: int) -> int:
    return index * 37 % 251


class Memory:
    """Answers an address some cycles later."""

    def __init__(self, dut, cycles=READ_LATENCY):
        self._dut, self._asked = dut, [0] * cycles

    def step(self, ctx):
        ctx.set(self._dut.data, word(self._asked[0]))
        self._asked = [*self._asked[1:], ctx.get(self._dut.address)]


def take_all(dut, count, cycles, wanted, data_latency=READ_LATENCY):
    """Return the entries taken as (index, last, word), and the cycles in which there was none. An entry is taken in a
    cycle with ``wanted(cycle)``."""
    taken, missing, memory, expected = [], [], Memory(dut, data_latency), None

    async def bench(ctx):
        nonlocal expected
        ctx.set(dut.count, count)
        ctx.set(dut.flush, 1)
        for _ in range(3):
            memory.step(ctx)
            await ctx.tick()
        ctx.set(dut.flush, 0)
        for cycle in range(cycles):
            memory.step(ctx)
            valid, found = ctx.get(dut.entry.valid), ctx.get(dut.entry.word)
            assert not valid or found == expected, "it is not what was announced"
            take = bool(valid and wanted(cycle))
            moves = take or not valid
            ctx.set(dut.advances, moves)
            expected = ctx.get(dut.second_word) if moves else found
            if take:
                taken.append((ctx.get(dut.entry.index), ctx.get(dut.entry.last), ctx.get(dut.entry.word)))
            if not valid:
                missing.append(cycle)
            await ctx.tick()

    simulate(dut, bench)
    return taken, missing


def entries(count, number):
    return [(k % count, int(k % count == count - 1), word(k % count)) for k in range(number)]


@pytest.mark.parametrize("count", [1, 2, 3, 7, 8, 9, 1 << BITS])
@pytest.mark.parametrize("data_latency", range(READ_LATENCY, 10))  # some of them fill the queue
def test_an_entry_a_cycle_after_the_latency(count, data_latency):
    fetch = Fetch(index_bits=BITS, width=8, data_latency=data_latency)
    taken, missing = take_all(fetch, count, 200, lambda cycle: True, data_latency)
    assert missing == list(range(latency(data_latency)))
    assert taken == entries(count, 200 - len(missing))


@pytest.mark.parametrize("count", [1, 3, 50])
@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_entries_taken_at_any_rate(count, share, rng):
    taken, missing = take_all(Fetch(index_bits=BITS, width=8), count, 600, lambda cycle: rng.random() < share)
    assert missing == list(range(latency(READ_LATENCY)))  # never short of entries again
    assert taken == entries(count, len(taken)) and len(taken) > 30


def test_bursts_after_a_long_wait():
    taken, missing = take_all(Fetch(index_bits=BITS, width=8), 40, 400, lambda cycle: cycle % 50 > 20)
    assert missing == list(range(latency(READ_LATENCY)))
    assert taken == entries(40, len(taken))


def test_a_flush_starts_over_with_another_count(rng):
    """A flush at any moment leaves nothing of the old list."""
    dut, memory = Fetch(index_bits=BITS, width=8), None

    async def bench(ctx):
        nonlocal memory
        memory = Memory(dut)
        for _ in range(30):
            count, taken = int(rng.integers(1, 20)), []
            ctx.set(dut.count, count)
            ctx.set(dut.flush, 1)
            ctx.set(dut.advances, 1)
            for _ in range(rng.integers(1, 4)):
                memory.step(ctx)
                await ctx.tick()
            ctx.set(dut.flush, 0)
            for _ in range(rng.integers(0, 30)):
                memory.step(ctx)
                moves = rng.random() < 0.7
                ctx.set(dut.advances, moves)
                if moves and ctx.get(dut.entry.valid):
                    taken.append((ctx.get(dut.entry.index), ctx.get(dut.entry.last), ctx.get(dut.entry.word)))
                await ctx.tick()
            assert taken == entries(count, len(taken))

    simulate(dut, bench)


@pytest.mark.parametrize("there", [0.3, 0.7, 1.0])
def test_a_paced_fetch_advances_with_the_issue_register_of_its_list(there, rng):
    """The issue register, which is elsewhere, gets every entry once and in order."""
    m, fetch, issue = Module(), PacedFetch(index_bits=BITS, width=8), IssueRegister(width=8)
    m.submodules.fetch, m.submodules.issue = fetch, issue
    wiring.connect(m, fetch.advance, issue.advance)
    m.d.comb += [issue.flush.eq(fetch.flush), issue.next.eq(fetch.entry.word)]
    count, taken = 9, []

    async def bench(ctx):
        memory = Memory(fetch)
        ctx.set(fetch.count, count)
        for cycle in range(400):
            ctx.set(fetch.flush, cycle < 2)
            for ready in (fetch.next_ready, fetch.ready):
                ctx.set(ready, bool(rng.random() < there))
            memory.step(ctx)
            if ctx.get(issue.issue):
                taken.append(ctx.get(issue.entry))
            await ctx.tick()

    simulate(m, bench)
    assert taken == [word for _, _, word in entries(count, len(taken))] and len(taken) > 60
