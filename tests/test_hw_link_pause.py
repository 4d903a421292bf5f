"""A pause takes the cycles that it states, on a host port that answers as late as the real one."""

import pytest
from hw_objects import simulate

from hw.link.pause import PAUSE_CYCLES, RESUME_CYCLES, Pause
from hw.link.port import LATENCY
from hw.map.control import Control
from hw.map.memory_map import Region, join

DONE = 3
"""Steps done when the run is stopped."""


def control(register: Control) -> int:
    return join(Region.CONTROL, 0, register, 0)


async def exchange(ctx, dut, strobe, busy_until: int = 0):
    """Raise a strobe, answer each access, and return (cycles until ``done``, accesses)."""
    accesses, answers, cycle = [], {}, 0
    ctx.set(strobe, 1)
    await ctx.tick()
    ctx.set(strobe, 0)
    while True:
        cycle += 1
        ctx.set(dut.busy, cycle < busy_until)
        if ctx.get(dut.port.request):
            address, data = ctx.get(dut.port.address), ctx.get(dut.port.write_data)
            accesses.append((address, data) if ctx.get(dut.port.write) else address)
            answers[cycle + LATENCY] = DONE if address == control(Control.STEPS_DONE) else 0
        ctx.set(dut.port.answer, cycle in answers)
        ctx.set(dut.port.read_data, answers.get(cycle, 0))
        if ctx.get(dut.done):
            await ctx.tick()
            return cycle, accesses
        await ctx.tick()


async def note(ctx, dut, steps: int):
    ctx.set(dut.noted, 1)
    ctx.set(dut.steps, steps)
    await ctx.tick()
    ctx.set(dut.noted, 0)
    await ctx.tick()


def run(testbench):
    dut = Pause(36)

    async def bench(ctx):
        await testbench(ctx, dut)

    simulate(dut, bench)


def test_a_pause_and_what_follows_take_the_stated_cycles():
    async def testbench(ctx, dut):
        await note(ctx, dut, 10)
        pause = [(control(Control.STOP), 1), control(Control.STEPS_DONE)]
        assert await exchange(ctx, dut, dut.pause) == (PAUSE_CYCLES, pause)
        assert await exchange(ctx, dut, dut.resume) == (RESUME_CYCLES, [(control(Control.RUN), 10 - DONE)])

    run(testbench)


@pytest.mark.parametrize("late", [1, 50])
def test_a_pause_waits_until_the_run_is_over(late):
    """STOP is answered `LATENCY` + 1 cycles after its state, which is the first."""
    answered = 1 + 1 + LATENCY

    async def testbench(ctx, dut):
        await note(ctx, dut, 10)
        cycles, _ = await exchange(ctx, dut, dut.pause, answered + 1 + late)
        assert cycles == PAUSE_CYCLES + late

    run(testbench)


@pytest.mark.parametrize("steps", [0, DONE])
def test_nothing_is_resumed_when_no_step_is_left(steps):
    async def testbench(ctx, dut):
        await note(ctx, dut, steps)
        await exchange(ctx, dut, dut.pause)
        assert await exchange(ctx, dut, dut.resume) == (1, [])

    run(testbench)
