"""The serial line: bytes at slightly wrong rates, noise, missing stop bits, breaks."""

import itertools
import re

import pytest
from hw_objects import refused, simulate

from hw.link.uart import BAUD_LEAST, BAUD_MOST, LEAST_CYCLES, Receiver, Transmitter, cycles_per_bit


@pytest.mark.parametrize(
    ("clock_hz", "baud", "cycles"),
    [
        (125e6, 1_000_000, 125),
        (125e6, 3_000_000, 42),
        (25e6, 115_200, 217),
        (24e6, 3_000_000, LEAST_CYCLES),
    ],
)
def test_a_bit_has_a_whole_number_of_cycles(clock_hz, baud, cycles):
    assert cycles_per_bit(clock_hz, baud) == cycles


@pytest.mark.parametrize(
    ("clock_hz", "baud", "message"),
    [
        (125e6, BAUD_LEAST - 1, "baud must be 115200 to 3000000, not 115199"),
        (125e6, BAUD_MOST + 1, "baud must be 115200 to 3000000, not 3000001"),
        (20e6, 3_000_000, "baud must be at most 2500000 with a clock of 20 MHz, not 3000000"),
        (25e6, 2_950_000, None),
        (
            25e6,
            3_000_000,
            "baud must be a rate that a clock of 25 MHz meets within 1.5%, not 3000000: 8 cycles a bit are +4.2% off",
        ),
    ],
)
def test_a_rate_that_cannot_be_met_is_refused(clock_hz, baud, message):
    if message is None:
        message = (
            f"baud must be a rate that a clock of 25 MHz meets within 1.5%, not {baud}: 8 cycles a bit are "
            f"{25e6 / 8 / baud - 1:+.1%} off"
        )
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        cycles_per_bit(clock_hz, baud)


def test_a_receiver_needs_some_cycles_for_a_bit():
    message = f"cycles must be at least {LEAST_CYCLES}, not {LEAST_CYCLES - 1}"
    refused(lambda: Receiver(LEAST_CYCLES - 1), message)


def line_of(byte: int, stop: int = 1) -> list[int]:
    return [0, *(byte >> n & 1 for n in range(8)), stop]


def received(cycles: int, levels: list[int]) -> list[int | str]:
    """Return what a receiver reads from the line's level in each cycle: bytes, "error", "break"."""
    dut, seen = Receiver(cycles), []

    async def bench(ctx):
        for level in levels:
            ctx.set(dut.rx, level)
            await ctx.tick()
            if ctx.get(dut.received.valid):
                seen.append(ctx.get(dut.received.data))
            if ctx.get(dut.received.error):
                seen.append("break" if ctx.get(dut.received.broken) else "error")

    simulate(dut, bench)
    return seen


def sampled(bits: list[int], length: float) -> list[int]:
    """Return the line's level in each cycle, for bits of any length in cycles; idle before and after."""
    levels = [bits[int(cycle / length)] for cycle in range(int(len(bits) * length))]
    return [1] * 20 + levels + [1] * 20


@pytest.mark.parametrize("cycles", [LEAST_CYCLES, 9, 41, 125])
@pytest.mark.parametrize("off", [-0.02, 0.0, 0.02])
def test_bytes_arrive_at_a_rate_that_is_off_by_two_percent(cycles, off, rng):
    """They follow each other without a pause."""
    sent = [0x00, 0xFF, 0x55, 0xAA, *(int(b) for b in rng.integers(0, 256, 20))]
    bits = [bit for byte in sent for bit in line_of(byte)]
    assert received(cycles, sampled(bits, cycles * (1 + off))) == sent


@pytest.mark.campaign
@pytest.mark.parametrize("cycles", [LEAST_CYCLES, 41])
def test_the_receiver_tolerates_its_stated_rate_error(cycles, rng, figure):
    """Measured in steps of half a per cent, with bytes that follow each other without a pause."""
    sent = [0x00, 0xFF, 0x55, 0xAA, *(int(b) for b in rng.integers(0, 256, 20))]
    bits = [bit for byte in sent for bit in line_of(byte)]

    def most(sign):
        steps = itertools.takewhile(
            lambda n: received(cycles, sampled(bits, cycles * (1 + sign * n / 200))) == sent, range(1, 21)
        )
        return max(steps, default=0) / 2

    figures = most(-1), most(1)
    figure(f"baud tolerance at the receiver, {cycles} cycles a bit, bits shorter and longer by, %", [2, 2], figures)
    assert min(figures) >= 2


@pytest.mark.parametrize("cycles", [LEAST_CYCLES, 41])
def test_a_short_pulse_is_no_start_bit_and_one_wrong_sample_no_wrong_bit(cycles, rng):
    sent = [int(b) for b in rng.integers(0, 256, 8)]
    levels = [1] * 20 + [0] * (cycles // 4) + [1] * (2 * cycles)
    for byte in sent:
        for bit in line_of(byte):
            wave = [bit] * cycles
            if bit == 1:  # the middle sample, which is two registers after the line
                wave[cycles // 2] = 0
            levels += wave
    assert received(cycles, levels + [1] * 20) == sent


def test_a_missing_stop_bit_and_a_break_are_told_apart_and_the_next_byte_arrives():
    cycles, idle = 16, [1] * 3
    bits = [*line_of(0x41, stop=0), *idle, *line_of(0x42), *[0] * 25, *idle, *line_of(0x43)]
    assert received(cycles, sampled(bits, cycles)) == ["error", 0x42, "break", 0x43]


@pytest.mark.parametrize("cycles", [LEAST_CYCLES, 42])
def test_a_transmitter_sends_what_a_line_carries(cycles, rng):
    sent = [0x00, 0xFF, *(int(b) for b in rng.integers(0, 256, 6))]
    dut, levels = Transmitter(cycles), []

    async def bench(ctx):
        waiting = list(sent)
        for _ in range((len(sent) * 10 + 1) * cycles + 2 * len(sent)):
            ctx.set(dut.bytes.valid, bool(waiting))
            ctx.set(dut.bytes.data, waiting[0] if waiting else 0)
            if waiting and ctx.get(dut.bytes.ready):
                waiting.pop(0)
            await ctx.tick()
            levels.append(ctx.get(dut.tx))

    simulate(dut, bench)
    assert received(cycles, levels) == sent
    assert levels[: 2 * cycles] == [0] * (2 * cycles)  # a start bit at once, and the first bit of 0x00
