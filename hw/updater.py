"""A node updater: one node per cycle, from the sums of forces to the next stage's position and velocity."""

from functools import cached_property

from amaranth.hdl import Cat, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden import records
from golden.datapath import node_graph
from golden.formats import Formats
from golden.graph import AXES

from .accumulator import READ
from .blocks.memory import READ_LATENCY, BlockRam
from .cost import Cost
from .delay import DelayLines
from .edge import fault_names
from .host import HANDOVER, handed
from .lane import NODE_WORDS
from .operations import shape
from .parameters import Parameters
from .pipe import Pipe
from .schedule import Schedule

RESULTS = {"x_base": "x", "v_base": "v", "v": "v", "x_total": "x_total", "v_total": "v_total"}
"""Where a node's memories get their next words from; a base is written in a step's last stage."""


GATHERED = READ + 1
"""Cycles from the issue of a node to its sums of forces in registers: they come from all lanes."""


class NodeDatapath:
    """`golden.datapath.node_graph` with its schedule.

    Only the sums of forces come with the node, two for each lane; a node's own words are read when they are needed.
    """

    def __init__(self, formats: Formats, lanes: int, cost: Cost):
        self.formats, self.cost, self.banks = formats, cost, 2 * lanes

    @cached_property
    def graph(self):
        graph = node_graph(self.formats, self.banks)
        graph.keep({name: node for name, node in graph.outputs.items() if "base_next" not in name})
        return graph

    @cached_property
    def schedule(self):
        late = {name for name in self.graph.inputs if not name.startswith(("pull", "velocity_shift"))}
        return Schedule(self.graph, self.cost, late=late, static={"velocity_shift"})

    @cached_property
    def faults(self) -> list[str]:
        """Names of all faults that the datapath can report, sorted."""
        return fault_names(self.graph)

    @property
    def done(self) -> int:
        """The cycle in which all results, rounded, are in registers: from there they go far."""
        return self.schedule.latency + 1

    @property
    def latency(self) -> int:
        """Cycles from the issue of a node to its new state."""
        return GATHERED + self.done


class NodeUpdater(wiring.Component):
    """`golden.node.node` as a pipeline, with the memories of the nodes' own words: of one node in each row of nodes.

    Latency: a node's new state is on ``update_*`` ``datapath.latency`` cycles after it was issued. Throughput one node
    a cycle.

    Members
    -------
    valid, row : In
        The row of the node that is issued.
    mask : In
        Which accumulators hold a force on it, two for each lane (first ends, second ends); read with the node.
    stage_first, stage_last, stage_half, stage_double : In(1)
    velocity_shift : In
    sum<bank>_* : In
        The sums of forces on the node, `hw.accumulator.READ` cycles after it was issued.
    update, update_row, update_x_*, update_v_* : Out
        As `hw.lane.Lane` takes them.
    fault : Out
        One bit for each name in ``datapath.faults``.
    host_* : In / Out
        Reads and writes of the host, only while no node is under way; see `hw.host`. They are `HANDOVER` cycles on
        their way to the memories.
    """

    def __init__(self, parameters: Parameters, datapath: NodeDatapath):
        self.parameters, self.datapath = parameters, datapath
        self.banks, self.schedule, fmt = datapath.banks, datapath.schedule, parameters.formats
        self._mass = records.inverse_mass(fmt)
        update = {"x": fmt.position, "v": fmt.velocity}
        super().__init__(
            {
                "valid": In(1),
                "row": In(parameters.node_row_bits),
                "mask": In(self.banks),
                **{f"stage_{bit}": In(1) for bit in ("first", "last", "half", "double")},
                "velocity_shift": In(shape(fmt.exponent)),
                **{f"sum{bank}_{axis}": In(shape(fmt.accumulator)) for bank in range(self.banks) for axis in AXES},
                "update": Out(1),
                "update_row": Out(parameters.node_row_bits),
                **{f"update_{word}": Out(shape(update[word[0]])) for word in NODE_WORDS},
                "fault": Out(len(self.datapath.faults)),
                "host": In(1),
                "host_index": In(parameters.index_bits),
                "host_data": In(fmt.state),
                "host_write_state": In(len(NODE_WORDS)),
                "host_write_load": In(len(AXES)),
                "host_write_mass": In(1),
                **{f"host_{word}": Out(fmt.state) for word in NODE_WORDS},
                **{f"host_{quantity}_{axis}": Out(fmt.state) for quantity in ("load", "force") for axis in AXES},
                "host_mass": Out(fmt.state),
            }
        )

    def elaborate(self, platform):
        m = Module()
        self._m, self._lines = m, DelayLines(m)
        inputs = {"velocity_shift": self._lines.later(self.velocity_shift, 1)}
        for bit in ("first", "last", "half", "double"):
            name = f"stage_{bit}"
            inputs[name] = self._later(getattr(self, name), self.schedule.arrival[name])
        others = Signal.like(self.mask, name="others")
        m.d.comb += others.eq(~self.mask)
        others = self._lines.later(others, READ)
        for bank in range(self.banks):
            for axis in AXES:
                total = getattr(self, f"sum{bank}_{axis}")
                name = f"pull{bank}_{axis}"
                inputs[name] = pull = Signal(total.shape(), name=name, reset_less=True)
                m.d.sync += pull.eq(Mux(others[bank], 0, total))
        memories = self._memories(inputs)
        pipe = Pipe(m, self.schedule, inputs, self._later(self.valid, 0))
        self._write_back(pipe, memories)
        m.d.comb += self.fault.eq(Cat(pipe.faults[name] for name in self.datapath.faults))
        pipe.build()
        self._lines.build()
        return m

    def _later(self, value, cycle: int):
        """What was issued, when its node is in ``cycle`` of the pipeline; its sums are gathered before cycle 0."""
        return self._lines.later(value, GATHERED + cycle, reset=value is self.valid)

    def _host(self, name: str):
        """What comes from the host, which is far, in the cycle before it reaches the memories."""
        name = f"host_{name}".rstrip("_")
        return self._lines.later(getattr(self, name), HANDOVER - 1, name=name, reset=True)

    def _memory(self, name: str, width: int, arrival: int) -> BlockRam:
        """A word per node, read for ``arrival``, or for the host."""
        ram = BlockRam(width=width, depth=self.parameters.node_rows)
        self._m.submodules[name] = ram
        address = self._later(self.row, arrival - READ_LATENCY - 1 - self._early(arrival))
        handed(self._m, ram, name, self._host(""), {"address": self._host("index")}, {"address": address})
        return ram

    def _written(self, name: str, ram: BlockRam, **writers):
        """What is written: a strobe and a word of each who writes, ``by_host`` or ``own``."""
        places = {"by_host": self._host("index"), "own": self._later(self.row, self.datapath.done)}
        ports = {"by_host": {}, "own": {}}
        for who, (strobe, word) in writers.items():
            ports[who] = {"write": strobe, "write_address": places[who], "write_data": word}
        handed(self._m, ram, name, self._host(""), **ports)

    def _memories(self, inputs):
        memories, arrival = {}, self.schedule.arrival
        for quantity, q in records.node_state(self.parameters.formats).items():
            for axis in AXES:
                name = f"{quantity}_{axis}"
                memories[name] = ram = self._memory(f"node_{name}", q.width, arrival[name])
                inputs[name] = self._near(name, ram, q)
        for number, axis in enumerate(AXES):
            q = self.parameters.formats.accumulator
            ram = self._memory(f"load_{axis}", q.width, arrival[f"load_{axis}"])
            inputs[f"load_{axis}"] = self._near(f"load_{axis}", ram, q)
            self._written(f"load_{axis}", ram, by_host=(self._host("write_load")[number], self._host("data")))
            self._m.d.comb += getattr(self, f"host_load_{axis}").eq(ram.data)
        low = 0
        for part, q in self._mass.items():
            name = f"inverse_mass_{part}"
            ram = self._memory(name, q.width, arrival[name])
            inputs[name] = self._near(name, ram, q)
            self._written(name, ram, by_host=(self._host("write_mass"), self._host("data")[low : low + q.width]))
            self._m.d.comb += self.host_mass[low : low + q.width].eq(ram.data)
            low += q.width
        return memories

    def _near(self, name: str, ram: BlockRam, q):
        """A memory's word when the pipeline needs it, where there is time for it from a register: the place of a memory
        is given."""
        word = Signal(shape(q), name=f"near_{name}", reset_less=True)
        self._m.d["sync" if self._early(self.schedule.arrival[name]) else "comb"] += word.eq(ram.data)
        return word

    def _early(self, arrival: int) -> bool:
        """Whether a word that is needed then can be read a cycle before."""
        return GATHERED + arrival - READ_LATENCY - 1 > 0

    def _write_back(self, pipe, memories):
        m, done = self._m, self.datapath.done
        valid, last = self._later(self.valid, done), self._later(self.stage_last, done)
        strobes = dict(zip(NODE_WORDS, self._host("write_state"), strict=True))
        for quantity, result in RESULTS.items():
            for axis in AXES:
                by_host = {}
                if quantity in ("x_base", "v_base", "v"):
                    by_host["by_host"] = strobes[f"{quantity[0]}_{axis}"], self._host("data")
                own = valid & last if "base" in quantity else valid, pipe.output(f"{result}_{axis}", done)
                name = f"{quantity}_{axis}"
                self._written(f"node_{name}", memories[name], own=own, **by_host)
        for word in NODE_WORDS:
            m.d.comb += getattr(self, f"update_{word}").eq(pipe.output(word, done))
            m.d.comb += getattr(self, f"host_{word}").eq(memories[f"{word[0]}_base{word[1:]}"].data)
        m.d.comb += [self.update.eq(valid), self.update_row.eq(self._later(self.row, done))]
        for axis in AXES:
            force = BlockRam(width=self.parameters.formats.state, depth=self.parameters.node_rows)
            m.submodules[f"force_{axis}"] = force
            self._written(f"force_{axis}", force, own=(valid, pipe.output(f"force_{axis}", done)))
            m.d.sync += force.address.eq(self._host("index"))
            m.d.comb += getattr(self, f"host_force_{axis}").eq(force.data)
