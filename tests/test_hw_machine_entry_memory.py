"""The memory of a list: what the host writes is what the fetch and the host read, each in its cycle."""

from hw_objects import simulate

from hw.machine.entry_memory import LATENCY, REGISTERS, EntryMemory


def test_what_is_written_is_read_by_both(rng):
    dut, words = EntryMemory(width=12, depth=20), [int(w) for w in rng.integers(0, 1 << 12, 20)]

    async def bench(ctx):
        for place, word in enumerate(words):
            ctx.set(dut.host.write, 1)
            ctx.set(dut.host.index, place)
            ctx.set(dut.host.data, word)
            await ctx.tick()
        ctx.set(dut.host.write, 0)
        for host in (0, 1):
            ctx.set(dut.host.active, host)
            asked = [int(place) for place in rng.integers(0, 20, 100)]
            for cycle in range(len(asked) + LATENCY):
                if cycle < len(asked):
                    mine, other = (dut.host.index, dut.address)[:: 1 if host else -1]
                    ctx.set(mine, asked[cycle])
                    ctx.set(other, int(rng.integers(20)))
                await ctx.tick()
                if cycle >= LATENCY - 1 and cycle - LATENCY + 1 < len(asked):
                    assert ctx.get(dut.entry) == words[asked[cycle - LATENCY + 1]]
                found = cycle - (LATENCY - REGISTERS) + 1  # the host has the word before the last registers
                if 0 <= found < len(asked):
                    assert ctx.get(dut.host.word) == words[asked[found]]

    simulate(dut, bench)
