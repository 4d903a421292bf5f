"""The host port: what it takes, what it refuses, and that a refusal changes nothing."""

import numpy as np
import pytest
from host_port import FAULTS, MAP, MEMORIES, STATE, P, Port, content, control, use
from hw_objects import simulate

from hw.machine.control_registers import ANYTIME
from hw.machine.host_port import LATENCY
from hw.machine.interfaces import named
from hw.map.control import COUNTERS as NAMES
from hw.map.control import MAGIC, REGISTERS, VERSION, Control
from hw.map.memory_map import Region, join

FIXED = {
    Control.MAGIC: MAGIC,
    Control.VERSION: VERSION,
    Control.LANES: 3,
    Control.UPDATES: 1,
    Control.NODES: 20,
    Control.ROWS: 11,
    Control.MATERIALS: 5,
    Control.TABLES: 1,
    Control.AXES: 3,
}
COUNTERS = {
    **{control: (name, 12345 + (1 << 30 + control // 3)) for control, name in NAMES.items()},
    Control.STEPS_DONE: ("steps_done", 4_000_000_000),
}
BEYOND = {
    region: dict(index=MAP.depth(region), word=len(MAP.words(region)), lane=MAP.lanes(region)) for region in Region
}
REFUSED = {
    f"{region.name} {part} beyond its {'last' if value == least else 'furthest'}": (write, join(region, **place), 1)
    for region in Region
    for part, least in BEYOND[region].items()
    for value, write in ((least, 0), (least, 1), ({"index": 65535, "word": 31, "lane": 7}[part], 1))
    for place in [dict(index=0, word=0, lane=0) | {part: value}]
}
REFUSED |= {f"region {region}": (write, join(region, 0, 0, 0), 1) for region in (5, 6, 7) for write in (0, 1)}
REFUSED |= {f"a write to {r.name}": (1, control(r), 1) for r, row in REGISTERS.items() if not row.writable}
REFUSED |= {f"a write to {word}": (1, MAP.address(Region.NODE, word, 3), 1) for word in MAP.words(Region.NODE)[-3:]}
REFUSED |= {
    "no rows": (1, control(Control.ROW_COUNT), 0),
    "more rows than there is room for": (1, control(Control.ROW_COUNT), P.rows + 1),
    "2**32 rows": (1, control(Control.ROW_COUNT), 1 << 32),
    "no nodes": (1, control(Control.NODE_COUNT), 0),
    "more nodes than there is room for": (1, control(Control.NODE_COUNT), P.nodes + 1),
    "a velocity scale beyond the format": (1, control(Control.VELOCITY_SHIFT), 128),
    "a run of 0 steps": (1, control(Control.RUN), 0),
    "a run of 2**32 steps": (1, control(Control.RUN), 1 << 32),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_bad_request_is_refused_and_counted_and_changes_nothing(name):
    async def scenario(ctx, port):
        before = await port.state(ctx)
        assert await port.request(ctx, *REFUSED[name]) == (True, 0)
        assert await port.state(ctx) == before
        assert await port.read(ctx, Control.REFUSED) == 1

    use(scenario)


ANYWHERE = {region: join(region, 0, MAP.depth(region) - 1, 0) for region in MEMORIES}
BUSY = {f"{'write' if write else 'read'} {r.name}": (write, a, 1) for r, a in ANYWHERE.items() for write in (0, 1)}
BUSY |= {
    f"write {r.name}": (1, control(r), 1)
    for r in (Control.ROW_COUNT, Control.NODE_COUNT, Control.VELOCITY_SHIFT, Control.RUN)
}


@pytest.mark.parametrize("name", BUSY)
def test_a_request_is_refused_only_while_steps_are_run(name):
    async def scenario(ctx, port):
        ctx.set(port.dut.busy, 1)
        before = await port.state(ctx)
        assert await port.request(ctx, *BUSY[name]) == (True, 0)
        assert await port.state(ctx) == before
        assert await port.read(ctx, Control.BUSY) == 1
        ctx.set(port.dut.busy, 0)
        refused, _ = await port.request(ctx, *BUSY[name])
        assert not refused
        assert await port.read(ctx, Control.REFUSED) == 1

    use(scenario)


@pytest.mark.parametrize("name", [name for name in BUSY if name != "write RUN"])
@pytest.mark.parametrize("later", [1, 2])
def test_requests_are_refused_from_the_cycle_after_the_start(name, later):
    """Requests that follow the start of a run at once are refused, though the machine is not busy yet."""
    write, address, data = BUSY[name]

    async def scenario(ctx, port):
        dut, errors, busy, before = port.dut, [], 0, await port.state(ctx)
        for cycle in range(later + LATENCY + 1):
            ctx.set(dut.bus.request, cycle in (0, later))
            ctx.set(dut.bus.write, 1 if cycle == 0 else write)
            ctx.set(dut.bus.address, control(Control.RUN) if cycle == 0 else address)
            ctx.set(dut.bus.write_data, 5 if cycle == 0 else data)
            ctx.set(dut.busy, busy)
            busy = busy or ctx.get(dut.start)  # the sequencer's answer, a cycle later
            if ctx.get(dut.bus.answer):
                errors.append(ctx.get(dut.bus.error))
            await port.cycle(ctx)
        assert errors == [0, 1] and port.starts == before[2] + 1 and ctx.get(dut.steps) == 5
        assert port.strobes == before[1]

    use(scenario)


def test_a_run_of_nothing_loaded_is_refused():
    port = Port()

    async def bench(ctx):
        for known in (None, Control.ROW_COUNT, Control.NODE_COUNT):
            if known is not None:
                await port.write(ctx, known, 3)
            refused, _ = await port.request(ctx, 1, control(Control.RUN), 1)
            assert refused == (known != Control.NODE_COUNT)
        assert port.starts == 1

    simulate(port.dut, bench)


@pytest.mark.parametrize("steps", [1, (1 << 32) - 1])
def test_a_run_starts_once(steps):
    async def scenario(ctx, port):
        await port.write(ctx, Control.RUN, steps)
        assert port.starts == 1 and ctx.get(port.dut.steps) == steps
        for _ in range(5):
            await port.cycle(ctx)
        assert port.starts == 1

    use(scenario)


def test_a_run_can_be_stopped_and_faults_and_refusals_cleared_while_it_goes_on():
    async def scenario(ctx, port):
        ctx.set(port.dut.busy, 1)
        for register in ANYTIME:
            assert (await port.request(ctx, 1, control(register), 1))[0] is False
            assert port.stops == (register == Control.STOP)
        assert await port.read(ctx, Control.REFUSED) == 0

    use(scenario)


def test_registers_have_their_values():
    async def scenario(ctx, port):
        counters = named(port.dut.counters) | {"steps_done": port.dut.steps_done}
        for name, value in COUNTERS.values():
            ctx.set(counters[name], value)
        expected = FIXED | {register: value for register, (_, value) in COUNTERS.items()}
        expected |= {
            Control.ROW_COUNT: 7,
            Control.NODE_COUNT: 9,
            Control.VELOCITY_SHIFT: 12,
            Control.RUN: 0,
            Control.STOP: 0,
            Control.FAULTS: 0,
            Control.REFUSED: 0,
            Control.BUSY: 0,
        }
        assert expected.keys() == set(Control)
        assert {register: await port.read(ctx, register) for register in Control} == expected
        assert (ctx.get(port.dut.rows), ctx.get(port.dut.nodes), ctx.get(port.dut.velocity_shift)) == (7, 9, 12)

    use(scenario)


def test_writes_reach_their_memory_and_reads_come_back(rng):
    """At addresses anywhere in range, also at the ends."""

    async def scenario(ctx, port):
        for region in MEMORIES:
            limits = MAP.depth(region), len(MAP.words(region)), MAP.lanes(region)
            for low_or_high in (lambda n: 0, lambda n: n - 1, rng.integers, rng.integers):
                index, word, lane = (int(low_or_high(n)) for n in limits)
                address, data = join(region, word, index, lane), int(rng.integers(1 << STATE))
                assert await port.request(ctx, 0, address) == (False, content(region, index, word, lane))
                if not MAP.read_only(region, MAP.words(region)[word]):
                    refused, _ = await port.request(ctx, 1, address, data)
                    assert not refused and port.strobes.pop() == (region, index, word, lane, data)
        assert not port.strobes
        assert await port.read(ctx, Control.REFUSED) == 0

    use(scenario)


def test_a_request_a_cycle_answers_in_order(rng):
    """Good and bad ones of all kinds, back to back."""
    cases = []
    for _ in range(300):
        if rng.random() < 0.4:
            write, address, data = list(REFUSED.values())[rng.integers(len(REFUSED))]
            cases.append((write, address, data, True, 0))
        else:
            region = MEMORIES[rng.integers(len(MEMORIES))]
            index, word, lane = (
                int(rng.integers(n)) for n in (MAP.depth(region), len(MAP.words(region)), MAP.lanes(region))
            )
            cases.append((0, join(region, word, index, lane), 0, False, content(region, index, word, lane)))
    gaps = rng.integers(0, 2, len(cases))

    async def scenario(ctx, port):
        dut, answers = port.dut, []
        for case, gap in [*zip(cases, gaps, strict=True), *[(None, 0)] * LATENCY, (None, 0)]:
            for left in reversed(range(gap + 1)):
                if ctx.get(dut.bus.answer):
                    answers.append((bool(ctx.get(dut.bus.error)), ctx.get(dut.bus.read_data)))
                ctx.set(dut.bus.request, bool(case and not left))
                if case:
                    for signal, value in zip(
                        (dut.bus.write, dut.bus.address, dut.bus.write_data), case[:3], strict=True
                    ):
                        ctx.set(signal, value)
                await port.cycle(ctx)
        assert answers == [case[3:] for case in cases]
        assert await port.read(ctx, Control.REFUSED) == sum(case[3] for case in cases) > 80

    use(scenario)


def test_the_count_of_refusals_is_cleared_by_any_write():
    async def scenario(ctx, port):
        for _ in range(3):
            await port.request(ctx, *REFUSED["a run of 0 steps"])
        assert await port.read(ctx, Control.REFUSED) == 3
        await port.write(ctx, Control.REFUSED, 0)
        assert await port.read(ctx, Control.REFUSED) == 0

    use(scenario)


def test_faults_stay_until_a_1_is_written(rng):
    async def scenario(ctx, port):
        sticky = 0
        for _ in range(40):
            happens = int(rng.integers(1 << FAULTS) & rng.integers(1 << FAULTS))
            ctx.set(port.dut.fault, happens)
            await port.cycle(ctx)
            ctx.set(port.dut.fault, 0)
            sticky |= happens
            assert await port.read(ctx, Control.FAULTS) == sticky
            clear = int(rng.integers(1 << FAULTS))
            ctx.set(port.dut.busy, int(rng.integers(2)))
            await port.write(ctx, Control.FAULTS, clear)
            sticky &= ~clear
            assert await port.read(ctx, Control.FAULTS) == sticky

    use(scenario)


def test_a_fault_that_happens_while_it_is_cleared_is_kept():
    async def scenario(ctx, port):
        ctx.set(port.dut.fault, 1)
        await port.cycle(ctx)
        await port.write(ctx, Control.FAULTS, 1)
        ctx.set(port.dut.fault, 0)
        assert await port.read(ctx, Control.FAULTS) == 1

    use(scenario)


def test_the_memory_model_tells_places_apart():
    places = [(r, i, w, l) for r in MEMORIES for i in range(5) for w in range(3) for l in range(3)]
    assert len(np.unique([content(*place) for place in places])) == len(places)
