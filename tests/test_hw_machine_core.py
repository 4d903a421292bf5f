"""The whole circuit in Amaranth's simulator, through its host port: the integers of `golden.datapath.machine`."""

import numpy as np
import pytest
from hw_objects import core_to_ask, refused, simulate
from integer_objects import MATERIALS, irregular, pressed, random_image

from golden.datapath.machine import Machine
from hw.machine.core import Core
from hw.machine.host_port import LATENCY
from hw.machine.lane import latency
from hw.map.control import Control
from hw.map.memory_map import NODE_FORCE, NODE_STATE, Map, Region, join
from hw.parameters import Parameters
from hw.pipeline.cost import Cost
from sim.encode.encode import encode
from sim.encode.program import Program


class Host:
    """Requests to a core, one a cycle."""

    def __init__(self, core):
        self.core, self._map = core, Map(core.parameters)

    async def requests(self, ctx, requests):
        """Return (error, data) of each of (write, address, data)."""
        core, answers = self.core, []
        for request in [*requests, *[None] * LATENCY]:
            ctx.set(core.request, request is not None)
            if request:
                for port, value in zip((core.write, core.address, core.write_data), request, strict=True):
                    ctx.set(port, value)
            await ctx.tick()
            if ctx.get(core.answer):
                answers.append((ctx.get(core.error), ctx.get(core.read_data)))
        assert len(answers) == len(requests)
        return answers

    async def write(self, ctx, writes):
        answers = await self.requests(ctx, [(1, address, data) for address, data in writes])
        assert not any(error for error, _ in answers)

    async def read(self, ctx, addresses):
        answers = await self.requests(ctx, [(0, address, 0) for address in addresses])
        assert not any(error for error, _ in answers)
        return np.array([data for _, data in answers])

    def control(self, register):
        return self._map.address(Region.CONTROL, 0, register)

    async def run(self, ctx, steps, limit=20000):
        await self.write(ctx, [(self.control(Control.RUN), steps)])
        for _ in range(limit):
            if not ctx.get(self.core.busy):
                return
            await ctx.tick()
        pytest.fail("the run does not end")

    async def registers(self, ctx, *registers):
        return (await self.read(ctx, [self.control(register) for register in registers])).tolist()

    async def assert_same(self, ctx, program, machine):
        """Compare every bit of positions, velocities, forces, ratios and faults."""
        addresses = [address for name in NODE_STATE + NODE_FORCE for address in program.node_addresses(name)]
        words = (await self.read(ctx, addresses)).reshape(9, -1).T
        expected = np.hstack([machine.x, machine.v, machine.force]) % (1 << self.core.parameters.formats.state)
        assert np.array_equal(words, expected)
        ratio = await self.read(ctx, program.edge_addresses("ratio"))
        assert np.array_equal(ratio, machine.ratio % (1 << self.core.parameters.formats.state))
        (bits,) = await self.registers(ctx, Control.FAULTS)
        named = {name for bit, name in enumerate(self.core.faults) if bits >> bit & 1}
        assert named == {name for name, count in machine.faults.items() if count}


def circuit(image, lanes, **kwargs):
    room = dict(
        nodes=image.nodes, edges=len(image.edges), materials=len(image.materials), tables=len(image.damper["rho_value"])
    )
    parameters = Parameters(lanes=lanes, **room | kwargs)
    return Core(parameters), Program(image, parameters), Machine(image)


def loading(program):
    """Return the writes of a program without the zeros of the damper tables, which are there from the start."""
    table = join(Region.TABLE, 0, 0, 0)
    return [(address, data) for address, data in program.load() if data or address < table]


@pytest.mark.parametrize(
    ("lanes", "updates", "axes", "press", "hold"),
    [
        pytest.param(1, 1, 3, [1, 2], [1], marks=pytest.mark.campaign),
        pytest.param(2, 1, 3, [1], [1], marks=pytest.mark.campaign),
        # test_hw_machine_routes.py runs this one with longer routes
        pytest.param(2, 2, 3, [1], [1], marks=pytest.mark.campaign),
        (1, 1, 1, [1, 2], [1]),
        pytest.param(2, 2, 1, [1], [1], marks=pytest.mark.campaign),
    ],
)
def test_a_pressed_block(lanes, updates, axes, press, hold, rng):
    """Runs of one step and of more, a new phase, the counters; requests are refused while it runs."""
    mesh = irregular((3, 2), rng)
    kinds = MATERIALS["rheological"], MATERIALS["plastic"]
    scene = pressed(mesh, kinds, 9, edge_material=rng.integers(2, size=len(mesh.edges)))
    loaded = encode(scene)
    image = loaded.image
    image.damper = {name: np.zeros_like(raw) for name, raw in image.damper.items()}  # linear dampers need none
    core, program, machine = circuit(image, lanes, updates=updates, axes=axes)
    host = Host(core)

    async def bench(ctx):
        await host.write(ctx, loading(program))
        for phase, runs in zip(scene.phases[:2], (press, hold), strict=True):
            velocity = loaded.start(phase, machine.v)
            machine.restart(velocity)
            await host.write(ctx, program.start(velocity, machine.x))
            for steps in runs:
                machine.step(steps)
                await host.run(ctx, steps)
                await host.assert_same(ctx, program, machine)
                names = (Control.STEPS_DONE, Control.ROWS_ISSUED, Control.EDGES_ISSUED, Control.CYCLES)
                done, rows, edges, cycles = await host.registers(ctx, *names)
                assert (done, rows, edges) == (steps, 4 * steps * program.rows, 4 * steps * len(image.edges))
                waits = await host.registers(ctx, Control.NODE_WAITS, Control.LIST_WAITS, Control.END_WAITS)
                assert cycles == rows + sum(waits)
        assert not machine.faults and (machine.x != image.x).any()

        if lanes > 1:
            return
        place = program.node_addresses("x_x")[0]
        answers = await host.requests(ctx, [(1, host.control(Control.RUN), 1), (1, place, 5), (0, place, 0)])
        assert [error for error, _ in answers] == [0, 1, 1]
        while ctx.get(core.busy):
            await ctx.tick()
        machine.step()
        await host.assert_same(ctx, program, machine)
        refusals, cycles = await host.registers(ctx, Control.REFUSED, Control.CYCLES)
        assert refusals == 2
        assert 4 * latency(core.datapath) < cycles < 4 * (latency(core.datapath) + core.node_datapath.latency + 40)

    simulate(core, bench)


def test_random_integers_and_their_faults(rng):
    """Nearly everything saturates; nodes without an edge, edges in any order, a capacity larger than the object."""
    image = random_image(rng, nodes=7, edges=10, materials=2, tables=1)
    used = rng.random(image.damper["rho_value"].shape) < 0.05
    image.damper = {name: np.where(used, raw, 0) for name, raw in image.damper.items()}
    core, program, machine = circuit(image, 1, nodes=16, edges=40, tables=2)
    host = Host(core)

    async def bench(ctx):
        await host.write(ctx, loading(program))
        await host.write(ctx, program.start(image.v, image.x))
        machine.step()
        await host.run(ctx, 1)
        await host.assert_same(ctx, program, machine)
        assert len(machine.faults) > 2

    simulate(core, bench)


def test_an_edge_whose_words_come_back_too_late_is_refused():
    """Late for its next stage, or for the host who reads them after the last."""
    core_to_ask(Parameters(cost=Cost(less=10)))
    refused(
        lambda: Core(Parameters(cost=Cost(less=11))), "the edge's base must be written within 87 cycles, not after 88"
    )
