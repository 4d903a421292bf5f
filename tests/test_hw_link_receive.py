"""The frame receiver: a good frame arrives whole, a damaged one not at all, and each kind of damage is counted."""

from collections import Counter

import pytest
from hw_objects import simulate
from link_objects import KEY, feed, taken

from hw.link.frame import GREETING, PAYLOAD_MOST, Frame, FrameError, unpacked
from hw.link.interfaces import EVENTS
from hw.link.receive import SLOTS, FrameReceiver


def received(line: bytes, frames: int):
    """Return the events that a receiver counts for these bytes, and its first frames."""
    dut, seen, got = FrameReceiver(KEY), Counter(), []

    async def bench(ctx):
        await feed(ctx, dut, line, seen)
        for _ in range(frames):
            got.append(await taken(ctx, dut))
        assert not ctx.get(dut.frame)

    simulate(dut, bench)
    return +seen, got


@pytest.mark.parametrize("size", [0, 1, 242, 243, 244, 245, 246, 300, PAYLOAD_MOST])
@pytest.mark.parametrize("content", ["zeros", "ones", "random"])
def test_a_frame_arrives_whole(size, content, rng):
    """Sizes are those around which COBS begins another block."""
    payload = {"zeros": bytes(size), "ones": b"\1" * size, "random": rng.bytes(size)}[content]
    frame = Frame(7, 200, payload=payload)
    assert received(frame.packed(KEY), 1) == ({"good_frames": 1}, [(7, 200, payload)])


def test_frames_wait_in_order_and_one_too_many_is_dropped(rng):
    payloads = [rng.bytes(n) for n in range(SLOTS + 1)]
    line = b"".join(Frame(2, n, payload=payload).packed(KEY) for n, payload in enumerate(payloads))
    seen, got = received(line, SLOTS)
    assert seen == {"good_frames": SLOTS, "overruns": 1}
    assert got == [(2, n, payload) for n, payload in enumerate(payloads[:SLOTS])]


def test_a_frame_for_which_room_comes_too_late_is_dropped(rng):
    """There is room again only after its first bytes."""
    dut, seen = FrameReceiver(KEY), Counter()
    frames = [(2, n, rng.bytes(20)) for n in range(SLOTS + 2)]
    packed = [Frame(type_, n, payload=payload).packed(KEY) for type_, n, payload in frames]

    async def bench(ctx):
        await feed(ctx, dut, b"".join(packed[:SLOTS]) + packed[SLOTS][:12], seen)
        assert await taken(ctx, dut) == frames[0]
        await feed(ctx, dut, packed[SLOTS][12:] + packed[SLOTS + 1], seen)
        for frame in (*frames[1:SLOTS], frames[SLOTS + 1]):
            assert await taken(ctx, dut) == frame
        assert not ctx.get(dut.frame)

    simulate(dut, bench)
    assert +seen == {"good_frames": SLOTS + 1, "overruns": 1}


@pytest.mark.parametrize(("type_", "good"), [(GREETING, True), (2, False)])
def test_only_a_greeting_is_understood_with_another_key(type_, good):
    line = Frame(type_, 0, payload=b"hello").packed(bytes(8))
    seen, _ = received(line, int(good))
    assert seen == {"good_frames" if good else "crc_errors": 1}


def test_zeros_alone_are_no_error():
    assert received(bytes(9), 0) == ({}, [])


DAMAGES = 150


def damaged(rng):
    """Yield (bytes without zeros, kind) of frames with a byte changed, lost or doubled, or with the rest missing."""
    for n in range(DAMAGES):
        good = Frame(2, n, payload=rng.bytes(int(rng.integers(0, 9)))).packed(KEY)[1:-1]
        at = int(rng.integers(len(good)))
        other = int(rng.choice([byte for byte in range(1, 256) if byte != good[at]]))
        coded = (
            good[:at] + bytes([other]) + good[at + 1 :],
            good[:at] + good[at + 1 :],
            good[:at] + good[at : at + 1] + good[at:],
            good[:at],
        )[n % 4]
        try:
            unpacked(coded, KEY)
        except FrameError as error:
            yield coded, error.kind


def test_nothing_of_a_damaged_frame_arrives_and_its_kind_is_counted(rng):
    good = Frame(2, 1, payload=b"good").packed(KEY)
    cases = list(damaged(rng))
    kinds = Counter(kind for coded, kind in cases if coded)
    line = b"".join(b"\0" + coded + b"\0" for coded, _ in cases)
    seen, got = received(line + good, 1)
    assert seen == kinds | {"good_frames": 1}
    assert got == [(2, 1, b"good")]
    assert set(kinds) == {"cobs_errors", "length_errors", "crc_errors"} and len(cases) > DAMAGES // 2


@pytest.mark.parametrize(
    ("port", "counted"),
    [
        ("error", {"line_errors": 1}),
        ("broken", {"line_errors": 1, "breaks": 1}),
    ],
)
def test_a_frame_with_a_broken_byte_is_dropped_and_the_next_one_accepted(port, counted):
    dut, seen = FrameReceiver(KEY), Counter()
    bad, good = (Frame(2, n, payload=b"payload").packed(KEY) for n in range(2))

    async def bench(ctx):
        await feed(ctx, dut, bad[:6], seen)
        ctx.set(dut.received.error, 1)
        ctx.set(dut.received.broken, port == "broken")
        for event in EVENTS:
            seen[event] += ctx.get(getattr(dut.events, event))
        await ctx.tick()
        ctx.set(dut.received.error, 0)
        ctx.set(dut.received.broken, 0)
        await feed(ctx, dut, (b"" if port == "broken" else bad[6:]) + good, seen)
        assert await taken(ctx, dut) == (2, 1, b"payload")
        assert not ctx.get(dut.frame)

    simulate(dut, bench)
    assert +seen == counted | {"good_frames": 1}
