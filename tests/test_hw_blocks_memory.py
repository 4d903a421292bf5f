"""Memories and the queue: a word appears when it should, and none is lost."""

from functools import partial

import pytest
from hw_objects import refused, simulate

from hw.blocks.memory import READ_LATENCY, BlockRam, LutRam
from hw.blocks.queue import Queue

MEMORIES = [(BlockRam, READ_LATENCY), (LutRam, 1)]
BITS = 36


@pytest.mark.parametrize(("kind", "latency"), MEMORIES)
@pytest.mark.parametrize("depth", [1, 2, 5, 64])
def test_a_word_appears_after_the_latency_one_a_cycle(kind, latency, depth, rng):
    dut = kind(width=BITS, depth=depth)
    contents = rng.integers(1 << BITS, size=depth).tolist()
    order = rng.integers(depth, size=4 * depth).tolist()
    seen = []

    async def bench(ctx):
        for index, word in enumerate(contents):
            ctx.set(dut.write, 1)
            ctx.set(dut.write_address, index)
            ctx.set(dut.write_data, word)
            await ctx.tick()
        ctx.set(dut.write, 0)
        for index in [*order, *[0] * latency]:
            seen.append(ctx.get(dut.data))
            ctx.set(dut.address, index)
            await ctx.tick()

    simulate(dut, bench)
    assert seen[latency:] == [contents[index] for index in order]


@pytest.mark.parametrize(("kind", "latency"), MEMORIES)
def test_reads_and_writes_at_the_same_time(kind, latency, rng):
    """A read finds the words of earlier cycles; no word is read in the cycle in which it is written."""
    depth, cycles = 8, 400
    dut, words = kind(width=BITS, depth=depth), [0] * depth
    expected, seen = [], []

    async def bench(ctx):
        for _ in range(cycles):
            seen.append(ctx.get(dut.data))
            write, place, word = int(rng.integers(2)), int(rng.integers(depth)), int(rng.integers(1 << BITS))
            address = int((place + rng.integers(1, depth)) % depth)
            ctx.set(dut.write, write)
            ctx.set(dut.write_address, place)
            ctx.set(dut.write_data, word)
            ctx.set(dut.address, address)
            expected.append(words[address])
            if write:
                words[place] = word
            await ctx.tick()

    simulate(dut, bench)
    assert seen[latency:] == expected[: cycles - latency]
    assert len(set(expected)) > cycles // 4


def test_a_block_ram_starts_with_its_contents():
    dut, contents, seen = BlockRam(width=8, depth=4, init=[5, 6, 7, 8]), [5, 6, 7, 8], []

    async def bench(ctx):
        for index in [*range(4), 0, 0]:
            seen.append(ctx.get(dut.data))
            ctx.set(dut.address, index)
            await ctx.tick()

    simulate(dut, bench)
    assert seen[READ_LATENCY:] == contents


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        (dict(width=8, depth=0), "depth must be at least 1, not 0"),
        (dict(width=0, depth=8), "width must be at least 1, not 0"),
    ],
)
@pytest.mark.parametrize("kind", [BlockRam, LutRam])
def test_a_memory_has_words_and_bits(kind, parameters, message):
    refused(partial(kind, **parameters), message)


@pytest.mark.parametrize("depth", [0, 1, 6])
def test_a_queue_has_a_power_of_two_of_places(depth):
    refused(partial(Queue, width=8, depth=depth), f"depth must be a power of two of at least 2, not {depth}")


@pytest.mark.parametrize(("puts", "takes"), [(0.9, 0.4), (0.4, 0.9), (1.0, 1.0)])
def test_a_queue_keeps_the_order(puts, takes, rng):
    """Compared with a list; flushed now and then."""
    dut, queue, flushes, fullest = Queue(width=16, depth=4), [], 0, 0

    async def bench(ctx):
        nonlocal flushes, fullest
        for _ in range(800):
            valid = ctx.get(dut.valid)
            assert valid == bool(queue)
            if valid:
                assert ctx.get(dut.data) == queue[0]
            take = bool(valid and rng.random() < takes)
            put = len(queue) - take < dut.depth and rng.random() < puts
            flush = rng.random() < 0.02
            word = int(rng.integers(1 << 16))
            for port, value in ((dut.take, take), (dut.put, put), (dut.flush, flush), (dut.data_in, word)):
                ctx.set(port, int(value))
            if take:
                queue.pop(0)
            if put:
                queue.append(word)
            if flush:
                queue.clear()
                flushes += 1
            fullest = max(fullest, len(queue))
            await ctx.tick()

    simulate(dut, bench)
    assert flushes > 5
    assert fullest == 4 or puts <= takes
