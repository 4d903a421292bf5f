"""Tests that `test_cocotb_core` runs in a simulator: the emitted circuit behind its host port, by its ports alone."""

import cocotb
import numpy as np
from cocotb_host import MAP, PARAMETERS, SEED, Object, control, start

from golden.datapath import records
from golden.datapath.machine import Machine
from golden.datapath.rk4 import RK4
from hw.machine.core import Core
from hw.map.control import COUNTERS, MAGIC, VERSION, Control
from hw.map.memory_map import NODE_FORCE, NODE_STATE, TABLE_WORDS, Region, join


@cocotb.test()
@cocotb.parametrize(name=["2-D", "3-D"])
async def what_is_written_is_read_and_steps_are_the_models(dut, name):
    one = Object(name)
    host = await start(dut, one)
    kept = one.kept()
    assert await host.read(kept) == list(kept.values())
    await host.run(2)
    one.model.step(2)
    await one.check(host)
    assert (one.model.x != one.image.x).any() and (one.model.ratio != one.image.ratio).any()
    assert await host.control(Control.FAULTS) == 0


@cocotb.test()
async def a_reset_circuit_says_what_it_is(dut):
    host = await start(dut)
    expected = {
        Control.MAGIC: MAGIC,
        Control.VERSION: VERSION,
        Control.LANES: 2,
        Control.UPDATES: 1,
        Control.NODES: 16,
        Control.ROWS: 32,
        Control.MATERIALS: 2,
        Control.TABLES: 1,
        Control.BUSY: 0,
        Control.REFUSED: 0,
        Control.RUN: 0,
        Control.STOP: 0,
        Control.ROW_COUNT: 0,
        Control.NODE_COUNT: 0,
        Control.CYCLES: 0,
        Control.STEPS_DONE: 0,
        Control.FAULTS: 0,
    }
    assert await host.read([control(register) for register in expected]) == list(expected.values())
    await host.refused([(1, control(Control.RUN), 1)])  # nothing is loaded


@cocotb.test()
async def a_run_in_pieces_is_the_same_run(dut):
    one, again = Object(), Object()
    host = await start(dut, one)
    await host.run(3)
    one.model.step(3)
    await one.check(host)
    x, v, _, ratio = await one.state(host)
    await host.run(2)
    one.model.step(2)
    await one.check(host)

    # The state after three steps, written back into the circuit after a reset
    again.image.x, again.image.v, again.image.ratio = x, v, ratio
    await host.reset()
    await host.write(again.writes())
    await host.run(2)
    await one.check(host)


@cocotb.test()
async def a_running_circuit_refuses_and_is_not_disturbed(dut):
    one = Object()
    host, kept = await start(dut, one), one.kept()
    await host.write([(control(Control.RUN), 2)])
    assert await host.control(Control.BUSY) == 1
    memory = [MAP.address(region, word) for region in Region if region for word in MAP.words(region)]
    registers = (Control.RUN, Control.ROW_COUNT, Control.NODE_COUNT, Control.VELOCITY_SHIFT)
    await host.refused([(1, address, 1) for address in memory + [control(register) for register in registers]])
    await host.refused([(0, address, 0) for address in memory])
    assert await host.control(Control.BUSY) == 1
    await host.wait()
    assert await host.control(Control.STEPS_DONE) == 2
    one.model.step(2)
    await one.check(host)
    changed = {a for name in NODE_STATE for a in one.program.node_addresses(name)}
    changed |= set(one.program.edge_addresses("ratio"))
    kept = {address: word for address, word in kept.items() if address not in changed}
    assert await host.read(kept) == list(kept.values())


@cocotb.test()
async def two_runs_at_once_are_one(dut):
    """The second request comes in the cycle after the first, before the circuit says that it is busy."""
    one = Object()
    host = await start(dut, one)
    answers = await host.transact([(1, control(Control.RUN), 1), (1, control(Control.RUN), 2)])
    assert [error for error, _ in answers] == [0, 1]
    await host.wait()
    one.model.step(1)
    await one.check(host)


@cocotb.test()
async def what_is_not_on_the_map_is_refused_and_nothing_changes(dut):
    one = Object()
    host, kept = await start(dut, one), one.kept()
    outside = []
    for region in Region:
        outside += [join(region, 0, MAP.depth(region), 0), join(region, 0, (1 << 16) - 1, 0)]
        outside += [join(region, len(MAP.words(region)), 0, 0), join(region, 31, 0, 0)]
        outside += [join(region, 0, 0, lane) for lane in range(MAP.lanes(region), 8)]
    outside += [join(region, 0, 0, 0) for region in range(len(Region), 8)]
    await host.refused([(write, address, 1) for address in outside for write in (0, 1)])

    read_only = [control(register) for register in Control if register <= Control.STEPS_DONE]
    read_only += [MAP.address(Region.NODE, name) for name in NODE_FORCE]
    await host.refused([(1, address, 1) for address in read_only])

    p = PARAMETERS
    impossible = [
        (Control.RUN, 0),
        (Control.RUN, 1 << 32),
        (Control.ROW_COUNT, 0),
        (Control.ROW_COUNT, p.rows + 1),
        (Control.ROW_COUNT, 1 << 32),
        (Control.NODE_COUNT, 0),
        (Control.NODE_COUNT, p.nodes + 1),
        (Control.NODE_COUNT, 1 << 32),
        (Control.VELOCITY_SHIFT, 128),
        (Control.VELOCITY_SHIFT, 1 << 32),
    ]
    await host.refused([(1, control(register), value) for register, value in impossible])

    assert await host.control(Control.BUSY) == 0
    assert await host.read(kept) == list(kept.values())
    await host.write([(control(Control.REFUSED), 0)])
    assert await host.control(Control.REFUSED) == 0
    await host.run(1)
    one.model.step(1)
    await one.check(host)


@cocotb.test()
async def the_counters_count(dut):
    one = Object()
    host = await start(dut, one)
    for steps in (3, 1):
        counted = await host.run(steps)
        assert await host.read([control(register) for register in (*COUNTERS, Control.STEPS_DONE)]) == [*counted, steps]
        cycles, rows, edges, *waits = counted
        assert rows == one.program.rows * RK4.stages * steps and edges == len(one.image.edges) * RK4.stages * steps
        assert cycles == rows + sum(waits) and all(waits)


@cocotb.test()
async def a_circuit_that_is_reset_in_a_run_is_loaded_again(dut):
    one, other = Object("3-D"), Object("small")
    host = await start(dut, one)
    for cycles in (1, 77, 300):
        await host.write([(control(Control.RUN), 1000)])
        for _ in range(cycles):
            await host.cycle()
        assert int(dut.busy.value) == 1
        await host.reset()
        assert int(dut.busy.value) == 0
        await host.write(one.writes())
    await host.write(other.writes())
    await host.run(1)
    other.model.step(1)
    await other.check(host)


@cocotb.test()
async def faults_stay_until_they_are_cleared(dut):
    """An edge whose ends are one point."""
    one = Object()
    one.image.x[one.image.edges[0, 0]] = one.image.x[one.image.edges[0, 1]]
    host = await start(dut, Object())
    await host.write(one.program.start(one.image.v, one.image.x))
    names = Core(PARAMETERS).faults
    await host.run(1)
    flags = await host.control(Control.FAULTS)
    model = Machine(one.image)
    model.step(1)
    assert "edge length" in model.faults
    assert {name for bit, name in enumerate(names) if flags >> bit & 1} == set(model.faults)
    lowest = flags & -flags
    await host.write([(control(Control.FAULTS), lowest)])
    assert await host.control(Control.FAULTS) == flags ^ lowest
    await host.write([(control(Control.FAULTS), (1 << 36) - 1)])
    assert await host.control(Control.FAULTS) == 0


@cocotb.test()
async def every_word_of_every_memory_holds_what_is_written(dut):
    """All bits of a word, at the first and the last index of each lane."""
    host = await start(dut)
    formats = {
        Region.NODE: {**dict.fromkeys(MAP.words(Region.NODE)[:9], 36), "inverse_mass": 26, "entry": 33},
        Region.EDGE: {"entry": records.edge_entry().width, "length": 36, "ratio": 36},
        Region.MATERIAL: {name: q.width for name, q in records.material(PARAMETERS.formats, 1).items()},
        Region.TABLE: dict.fromkeys(TABLE_WORDS, records.damper_word(PARAMETERS.formats).width // 2),
    }
    rng = np.random.default_rng(SEED)
    expected = {}
    for region, words in formats.items():
        for name, bits in words.items():
            for index in (0, MAP.depth(region) - 1):
                shared = int(rng.integers(1 << bits))
                for lane in range(MAP.lanes(region)):  # a write to a material or a table goes to all lanes
                    own = int(rng.integers(1 << bits)) if region == Region.EDGE else shared
                    expected[MAP.address(region, name, index, lane)] = own
    await host.write(expected.items())
    got = await host.read(expected)
    for address, word, want in zip(expected, got, expected.values(), strict=True):
        assert word & want == want and (word ^ want) >> 35 in (0, 1), hex(address)
