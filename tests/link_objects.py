"""Drivers of the link's components, cycle by cycle."""

from hw.blocks.memory import READ_LATENCY
from hw.link.interfaces import EVENTS
from hw.link.receive import BYTE_CYCLES

KEY = bytes(range(0xA0, 0xA8))


async def feed(ctx, receiver, line: bytes, seen: dict[str, int]):
    """Send bytes to a `FrameReceiver`, and add its events to ``seen``."""
    for byte in line:
        ctx.set(receiver.received.valid, 1)
        ctx.set(receiver.received.data, byte)
        for event in EVENTS:
            seen[event] += ctx.get(getattr(receiver.events, event))
        await ctx.tick()
        ctx.set(receiver.received.valid, 0)
        for _ in range(BYTE_CYCLES - 1):
            for event in EVENTS:
                seen[event] += ctx.get(getattr(receiver.events, event))
            await ctx.tick()


async def taken(ctx, receiver):
    """Take the first frame that waits; return (type, seq, payload)."""
    assert ctx.get(receiver.frame)
    payload = []
    for index in range(ctx.get(receiver.length)):
        ctx.set(receiver.index, index)
        for _ in range(READ_LATENCY):
            await ctx.tick()
        payload.append(ctx.get(receiver.byte))
    header = ctx.get(receiver.type), ctx.get(receiver.seq)
    ctx.set(receiver.take, 1)
    await ctx.tick()
    ctx.set(receiver.take, 0)
    await ctx.tick()
    return *header, bytes(payload)
