"""The CRC of a frame is that of zlib over key and frame."""

import zlib

import pytest
from hw_objects import refused, simulate
from link_objects import KEY

from hw.link.crc import FrameCrc
from hw.link.frame import ANSWER, GREETING, KEY_BYTES


@pytest.mark.parametrize(("type_", "keyed"), [(GREETING, False), (GREETING | ANSWER, False), (2, True), (0x83, True)])
def test_frames_in_a_row_have_the_crc_of_zlib(type_, keyed, rng):
    dut, frames = FrameCrc(KEY), [bytes([type_]) + rng.bytes(n) for n in (0, 1, 40)]

    async def bench(ctx):
        for frame in frames:
            expected = zlib.crc32(frame, zlib.crc32(KEY) if keyed else 0)
            ctx.set(dut.start, 1)
            await ctx.tick()
            ctx.set(dut.start, 0)
            cycles = 0
            for number, byte in enumerate(frame + expected.to_bytes(4, "little")):
                ctx.set(dut.data, byte)
                ctx.set(dut.valid, 1)
                while not ctx.get(dut.ready):
                    await ctx.tick()
                    cycles += 1
                if number == len(frame):
                    assert ctx.get(dut.crc) == expected
                await ctx.tick()
                ctx.set(dut.valid, 0)
            await ctx.tick()
            assert ctx.get(dut.ready) and ctx.get(dut.match)
            assert cycles == KEY_BYTES * keyed + number

    simulate(dut, bench)


def test_a_key_has_its_length():
    refused(lambda: FrameCrc(bytes(7)), f"key must be {KEY_BYTES} bytes, not 7")
