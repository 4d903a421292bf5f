"""The host side of the cocotb tests: the emitted circuit's host port, and objects to load through it.

Inputs change and outputs are looked at on the falling edge; reading an X as a number is an error.
"""

import numpy as np
from cocotb.clock import Clock
from cocotb.triggers import FallingEdge
from integer_objects import MATERIALS, irregular, pressed

from golden.datapath import records
from golden.datapath.machine import Machine
from hw.machine.host_port import LATENCY
from hw.map.control import Control
from hw.map.memory_map import NODE_FORCE, NODE_STATE, Map, Region, join
from hw.parameters import Parameters
from sim.encode.encode import encode
from sim.encode.program import Program

PARAMETERS = Parameters(lanes=2, nodes=16, edges=64, materials=2, tables=1)
MAP = Map(PARAMETERS)
SEED = 1
OBJECTS = {"2-D": ((3, 3), "rheological-force"), "3-D": ((2, 2, 2), "rheological"), "small": ((2, 2), "rheological")}
STATE = (*NODE_STATE, *NODE_FORCE)


class Host:
    """The host's side of the port."""

    def __init__(self, dut):
        self.dut = dut

    async def reset(self):
        self.dut.request.value = self.dut.write.value = self.dut.address.value = self.dut.write_data.value = 0
        self.dut.rst.value = 1
        for _ in range(2):
            await FallingEdge(self.dut.clk)
        self.dut.rst.value = 0
        await FallingEdge(self.dut.clk)

    async def cycle(self):
        """The next cycle: (error, read_data) if there is an answer in it."""
        await FallingEdge(self.dut.clk)
        return (int(self.dut.error.value), self.dut.read_data.value) if int(self.dut.answer.value) else None

    async def transact(self, requests):
        """(error, read_data) of each (write, address, data), one request a cycle; a good write reads None."""
        requests = list(requests)
        answers = []
        for write, address, data in requests:
            self.dut.request.value, self.dut.write.value = 1, write
            self.dut.address.value, self.dut.write_data.value = address, data
            answers.append(await self.cycle())
        self.dut.request.value = 0
        for _ in range(LATENCY):
            answers.append(await self.cycle())
        answers = [answer for answer in answers if answer]
        assert len(answers) == len(requests)
        return [
            (error, None if write and not error else int(data))
            for (write, _, _), (error, data) in zip(requests, answers, strict=True)
        ]

    async def write(self, writes):
        answers = await self.transact((1, address, data) for address, data in writes)
        assert all(error == 0 for error, _ in answers)

    async def read(self, addresses) -> list[int]:
        answers = await self.transact((0, address, 0) for address in addresses)
        assert all(error == 0 for error, _ in answers)
        return [data for _, data in answers]

    async def control(self, register) -> int:
        return (await self.read([control(register)]))[0]

    async def begin(self, steps):
        """A run; its first cycle is the one that comes now."""
        self.dut.request.value = self.dut.write.value = 1
        self.dut.address.value, self.dut.write_data.value = control(Control.RUN), steps
        await self.cycle()
        self.dut.request.value = 0
        while not int(self.dut.busy.value):
            assert await self.cycle() is None

    async def run(self, steps):
        await self.begin(steps)
        return await self.wait()

    async def wait(self):
        """Until the run is over: its counters (`hw.map.control.COUNTERS`), counted on the way."""
        counted = np.zeros(6, int)
        while int(self.dut.busy.value):
            sequencer = self.dut.sequencer
            row = int(sequencer.row__issue.value)
            edges = sum(self._issues(getattr(self.dut, f"lane{n}")) for n in range(PARAMETERS.lanes))
            waits = [int(getattr(sequencer, f"{why}_waits").value) for why in ("node", "list", "end")]
            counted += [1, row, edges, *waits]
            await self.cycle()
        return list(counted)

    @staticmethod
    def _issues(lane) -> int:
        """Return 1 if the lane issues a valid edge: the bit is the entry's last."""
        valid = int(lane.row_issue_entry.value) >> records.edge_entry().width - 1 & 1
        return int(lane.row_issue_issue.value) & valid

    async def refused(self, requests):
        """All of them are refused, counted, and answer nothing."""
        requests = list(requests)
        before = await self.control(Control.REFUSED)
        for request, answer in zip(requests, await self.transact(requests), strict=True):
            assert answer == (1, 0), f"write {request[0]}, address {request[1]:#x}, data {request[2]}"
        assert await self.control(Control.REFUSED) == before + len(requests)


def control(register):
    return MAP.address(Region.CONTROL, 0, register)


def signed(words):
    top = 1 << PARAMETERS.formats.state - 1
    return (np.array(words, np.int64) ^ top) - top


class Object:
    """A pressed object, its program, and the integer model that has been loaded with it."""

    def __init__(self, name="small"):
        nodes, material = OBJECTS[name]
        loaded = encode(pressed(irregular(nodes, np.random.default_rng(SEED)), MATERIALS[material], 30))
        self.image, self.model = loaded.image, Machine(loaded.image)
        self.program, self._tables = Program(self.image, PARAMETERS), loaded.scene.force_dependent

    def writes(self):
        """Without tables that nothing reads."""
        load = [(a, data) for a, data in self.program.load() if self._tables or a < join(Region.TABLE, 0, 0, 0)]
        return [*load, *self.program.start(self.image.v, self.image.x)]

    def kept(self):
        """Address -> what a read gives after `writes`: a material's fields have no more bits than they need."""
        kept, widths = dict(self.writes()), records.material(PARAMETERS.formats, PARAMETERS.tables)
        for number in range(len(self.image.materials)):
            for name, q in widths.items():
                kept[MAP.address(Region.MATERIAL, name, number)] &= (1 << q.width) - 1
        return kept

    async def state(self, host):
        """(x, v, force, ratio) as the circuit has them."""
        words = await host.read([a for name in STATE for a in self.program.node_addresses(name)])
        nodes = signed(words).reshape(len(STATE), -1).T
        ratio = signed(await host.read(self.program.edge_addresses("ratio")))
        return nodes[:, :3], nodes[:, 3:6], nodes[:, 6:], ratio

    async def check(self, host):
        model = self.model
        for name, got in zip(("x", "v", "force", "ratio"), await self.state(host), strict=True):
            assert np.array_equal(got, getattr(model, name)), name


async def start(dut, *objects):
    Clock(dut.clk, 10, unit="ns").start()
    host = Host(dut)
    await host.reset()
    for one in objects:
        await host.write(one.writes())
    return host
