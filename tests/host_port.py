"""A host port with memories, for the tests of `hw.machine.host_port`."""

from hw_objects import simulate

from hw.machine.host_port import LATENCY, HostPort
from hw.machine.interfaces import named
from hw.machine.routes import CHOICE, MEMORY
from hw.map.control import Control
from hw.map.memory_map import Map, Region, join
from hw.parameters import Parameters

P = Parameters(lanes=3, nodes=20, edges=31, materials=5, tables=1)
MAP = Map(P)
FAULTS = 6
STATE = P.formats.state
MEMORIES = [region for region in Region if region != Region.CONTROL]


def content(region, index, word, lane) -> int:
    """Return the word that the port's memories hold."""
    return hash((int(region), index, word, lane)) % (1 << STATE)


def control(register, lane=0, word=0):
    return join(Region.CONTROL, word, register, lane)


class Port:
    """A host port with memories, for one request at a time; records what reaches them."""

    def __init__(self):
        self.dut = HostPort(MAP, FAULTS)
        self.strobes, self.starts, self.stops = [], 0, 0
        self._asked = [(0, 0, 0)] * (MEMORY + 2 * CHOICE)

    async def cycle(self, ctx):
        dut = self.dut
        memories, words = dut.memories, named(dut.memories.words)
        for region in MEMORIES:
            ctx.set(words[region.name.lower()], content(region, *self._asked[0]))
        self._asked = [
            *self._asked[1:],
            tuple(ctx.get(port) for port in (memories.index, memories.word, memories.lane)),
        ]
        if strobe := ctx.get(memories.strobe):
            assert strobe.bit_count() == 1
        if strobe > 1 << Region.CONTROL:
            self.strobes.append((Region(strobe.bit_length() - 1), *self._asked[-1], ctx.get(memories.data)))
        self.starts += ctx.get(dut.start)
        self.stops += ctx.get(dut.stop)
        await ctx.tick()

    async def request(self, ctx, write, address, data=0):
        """(refused, data)"""
        bus = self.dut.bus
        for port, value in ((bus.write, write), (bus.address, address), (bus.write_data, data)):
            ctx.set(port, value)
        for cycle in range(LATENCY):
            assert not ctx.get(bus.answer)
            ctx.set(bus.request, cycle == 0)
            await self.cycle(ctx)
        assert ctx.get(bus.answer)
        answer = bool(ctx.get(bus.error)), ctx.get(bus.read_data)
        await self.cycle(ctx)
        return answer

    async def read(self, ctx, register):
        refused, data = await self.request(ctx, 0, control(register))
        assert not refused
        return data

    async def write(self, ctx, register, data):
        refused, _ = await self.request(ctx, 1, control(register), data)
        assert not refused

    async def state(self, ctx):
        """Return all that a refused request must not change."""
        registers = [Control.FAULTS, Control.ROW_COUNT, Control.NODE_COUNT, Control.VELOCITY_SHIFT]
        return [await self.read(ctx, r) for r in registers], list(self.strobes), self.starts, ctx.get(self.dut.steps)


def use(scenario):
    """Run a scenario on a port with 7 rows and 9 nodes in use."""
    port = Port()

    async def bench(ctx):
        await port.write(ctx, Control.ROW_COUNT, 7)
        await port.write(ctx, Control.NODE_COUNT, 9)
        await port.write(ctx, Control.VELOCITY_SHIFT, 12)
        await scenario(ctx, port)

    simulate(port.dut, bench)
