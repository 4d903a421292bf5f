"""The frame sender: the cobs package and zlib decode its frames."""

import pytest
from hw_objects import simulate
from link_objects import KEY

from hw.link.frame import ANSWER, GREETING, HEADER, Frame, unpacked
from hw.link.send import ANSWER_MOST, ANSWERS, FrameSender


def frame(number, payload, type_=2):
    return Frame(type_ | ANSWER, number, 0, payload)


async def stored(ctx, dut, number, frame):
    """Write an answer and request it."""
    body = HEADER.pack(frame.type, frame.seq, frame.status, 0, len(frame.payload)) + frame.payload
    ctx.set(dut.write, 1)
    ctx.set(dut.write_answer, number)
    for index, byte in enumerate(body):
        ctx.set(dut.write_index, index)
        ctx.set(dut.write_data, byte)
        await ctx.tick()
    ctx.set(dut.write, 0)
    await asked(ctx, dut, number, len(body))


async def asked(ctx, dut, number, length):
    ctx.set(dut.answer, number)
    ctx.set(dut.length, length)
    ctx.set(dut.send, 1)
    await ctx.tick()
    ctx.set(dut.send, 0)
    await ctx.tick()


async def line(ctx, dut, rng, slow=0.3) -> bytes:
    """Return all bytes that are sent until no answer waits; the line isn't always ready."""
    sent = []
    while ctx.get(dut.waits):
        ready = rng.random() > slow
        ctx.set(dut.sent.ready, ready)
        if ctx.get(dut.sent.valid) and ready:
            sent.append(ctx.get(dut.sent.data))
        await ctx.tick()
    ctx.set(dut.sent.ready, 0)
    return bytes(sent)


@pytest.mark.parametrize("size", [0, 1, 100, 242, 243, 244, 245, 246, 247, 248, 249, 300, ANSWER_MOST - HEADER.size])
@pytest.mark.parametrize("content", ["zeros", "ones", "random"])
def test_an_answer_is_sent_as_a_frame(size, content, rng):
    payload = {"zeros": bytes(size), "ones": b"\1" * size, "random": rng.bytes(size)}[content]
    whole, dut = frame(5, payload), FrameSender(KEY)

    async def bench(ctx):
        await stored(ctx, dut, 5, whole)
        sent = await line(ctx, dut, rng)
        assert sent[0] == sent[-1] == 0 and 0 not in sent[1:-1]
        assert unpacked(sent[1:-1], KEY) == whole
        assert len(sent) <= len(whole.packed(KEY))

    simulate(dut, bench)


def test_answers_are_sent_in_order_once_and_again_on_request(rng):
    dut = FrameSender(KEY)
    kept = [frame(n, rng.bytes(n), GREETING if n == 3 else 2) for n in range(ANSWERS)]
    order = [int(n) for n in rng.permutation(ANSWERS)]

    async def bench(ctx):
        for number in order:
            await stored(ctx, dut, number, kept[number])
            await asked(ctx, dut, number, HEADER.size + number)
        sent = await line(ctx, dut, rng)
        assert [unpacked(coded, KEY) for coded in sent.split(b"\0") if coded] == [kept[n] for n in order]
        for number in (4, 3):
            await asked(ctx, dut, number, 0)
        assert ctx.get(dut.waits) == 1 << 4 | 1 << 3
        sent = await line(ctx, dut, rng)
        assert [unpacked(coded, KEY) for coded in sent.split(b"\0") if coded] == [kept[4], kept[3]]

    simulate(dut, bench)


def test_an_answer_that_was_never_stored_is_not_sent():
    dut = FrameSender(KEY)

    async def bench(ctx):
        await asked(ctx, dut, 2, 0)
        assert not ctx.get(dut.waits)

    simulate(dut, bench)
