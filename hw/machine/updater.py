"""A node updater: from the sums of forces on a node to the next stage's position and velocity."""

from functools import cached_property

from amaranth.hdl import Cat, Const, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.graphs import node_graph
from golden.datapath.rk4 import RK4
from golden.numbers.graph import AXES, IN_TURN
from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.machine.accumulator import READ
from hw.machine.axis_serializer import AxisSerializer
from hw.machine.edge import fault_names
from hw.machine.host_port import HANDOVER, registered_ports
from hw.machine.lane import NODE_WORDS
from hw.parameters import Parameters
from hw.pipeline.cost import Cost
from hw.pipeline.delay import DelayLines
from hw.pipeline.operations import shape
from hw.pipeline.pipe import Pipe
from hw.pipeline.schedule import Schedule

RESULTS = {"x_base": "x", "v_base": "v", "v": "v", "x_total": "x_total", "v_total": "v_total"}
"""Where a node's memories get their next words from; a base is written in a step's last stage."""


GATHERED = READ + 1
"""Cycles from the issue of a node to its sums of forces in registers: they come from all lanes."""


class NodeDatapath:
    """`golden.datapath.graphs.node_graph` with its schedule.

    Only the sums of forces come with the node, two for each lane; a node's own words are read when they are needed.
    With ``cycles_per_node``, as many as a node has axes, these come one after the other.
    """

    def __init__(self, formats: Formats, lanes: int, cost: Cost, cycles_per_node: int = 1):
        self.formats, self.cost, self.banks, self.cycles_per_node = formats, cost, 2 * lanes, cycles_per_node
        self.axes = AXES if cycles_per_node == 1 else IN_TURN

    @cached_property
    def graph(self):
        graph = node_graph(self.formats, self.banks, self.axes)
        graph.keep({name: node for name, node in graph.outputs.items() if "base_next" not in name})
        return graph

    @cached_property
    def schedule(self):
        late = {name for name in self.graph.inputs if not name.startswith(("pull", "velocity_shift", "first_turn"))}
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
        return GATHERED + self.cycles_per_node - 1 + self.done


class NodeUpdater(wiring.Component):
    """`golden.datapath.node.node` as a pipeline, with the memories of the nodes' own words: of one node in each row of
    nodes.

    Latency: a node's new state is on ``update_*`` ``datapath.latency`` cycles after it was issued. Throughput one node
    in ``datapath.cycles_per_node`` cycles.

    Members
    -------
    valid, row : In
        The row of the node that is issued.
    mask : In
        Which accumulators hold a force on it, two for each lane (first ends, second ends); read with the node.
    stage_first, stage_last, stage_half, stage_double : In(1)
    velocity_shift : In
    sum<bank>_* : In
        The sums of forces on the node, `hw.machine.accumulator.READ` cycles after it was issued.
    update, update_row, update_x_*, update_v_* : Out
        As `hw.machine.lane.Lane` takes them.
    fault : Out
        One bit for each name in ``datapath.faults``.
    host_* : In / Out
        Reads and writes of the host, only while no node is under way; see `hw.machine.host_port`. They are `HANDOVER`
        cycles on their way to the memories. ``host_axis``, where the axes come one after the other, is that of the
        word.
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
                **({"host_axis": In(range(len(AXES)))} if datapath.cycles_per_node > 1 else {}),
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
        self._items()
        inputs = {"velocity_shift": self._lines.later(self.velocity_shift, 1)}
        for name, bit in self._stage.items():
            inputs[name] = self._later(bit, self.schedule.arrival[name])
        if self.datapath.cycles_per_node > 1:
            inputs["first_turn"] = self._later(self._first, 0)
        self._pulls(inputs)
        memories = self._memories(inputs)
        pipe = Pipe(m, self.schedule, inputs, self._later(self._valid, 0))
        self._write_back(pipe, memories)
        m.d.comb += self.fault.eq(Cat(pipe.faults[name] for name in self.datapath.faults))
        pipe.build()
        self._lines.build()
        return m

    def _items(self):
        """What goes through the pipeline, a node or one of its axes: ``_gathered`` cycles from its issue to its sums,
        ``_place`` in the memories of vectors, which have ``_depth`` words."""
        stage = {name: getattr(self, name) for name in map("stage_{}".format, RK4.stage(0))}
        self._valid, self._row, self._stage, self._gathered = self.valid, self.row, stage, GATHERED
        self._last, self._place, self._depth = self.valid, self.row, self.parameters.node_rows
        if self.datapath.cycles_per_node == 1:
            return
        node = Cat(self.row, *stage.values())
        self._m.submodules.turns = turns = AxisSerializer(width=len(node))
        self._m.d.comb += [turns.valid.eq(self.valid), turns.i.eq(node)]
        self._valid, self._first, self._last = turns.turn_valid, turns.first, turns.last
        self._gathered, self._depth = GATHERED - 1, len(AXES) << len(self.row)
        self._row, self._place = Signal.like(self.row, name="turn_row"), Signal(len(self.row) + len(turns.axis))
        self._stage = {name: Signal(name=f"turn_{name}") for name in stage}
        self._m.d.comb += [
            Cat(self._row, *self._stage.values()).eq(turns.o),
            self._place.eq(Cat(self._row, turns.axis)),
        ]

    def _pulls(self, inputs):
        """The sums on a node, side by side or one after the other."""
        m, turns = self._m, self.datapath.cycles_per_node
        others = Signal.like(self.mask, name="others")
        m.d.comb += others.eq(~self.mask)
        others = self._lines.later(others, READ)
        come = self._lines.later(self.valid, READ, reset=True) if turns > 1 else Const(1)
        for bank in range(self.banks):
            totals = [getattr(self, f"sum{bank}_{axis}") for axis in AXES]
            pulls = [
                Signal.like(total, name=f"pull{bank}_{axis}", reset_less=True)
                for total, axis in zip(totals, AXES, strict=True)
            ]
            for number, (pull, total) in enumerate(zip(pulls, totals, strict=True)):
                shown, behind = Mux(others[bank], 0, total), pulls[number + 1 :][: turns - 1]
                m.d.sync += pull.eq(Mux(come, shown, behind[0]) if behind else shown)
            inputs |= {f"pull{bank}_{axis}": pull for axis, pull in zip(self.datapath.axes, pulls, strict=False)}

    def _later(self, value, cycle: int):
        """What was issued, when its item is in ``cycle`` of the pipeline; its sums are gathered before cycle 0."""
        return self._lines.later(value, self._gathered + cycle, reset=value is self._valid or value is self._last)

    def _host(self, name: str):
        """What comes from the host, which is far, in the cycle before it reaches the memories."""
        name = f"host_{name}".rstrip("_")
        return self._lines.later(getattr(self, name), HANDOVER - 1, name=name, reset=True)

    def _host_place(self):
        """Where the host's word is in the memories of vectors."""
        index = self._host("index")
        return index if self.datapath.cycles_per_node == 1 else Cat(index[: len(self.row)], self._host("axis"))

    def _memory(self, name: str, width: int, arrival: int, *, vector: bool = True) -> BlockRam:
        """A word per node, or of a vector per item, read for ``arrival``, or for the host."""
        ram = BlockRam(width=width, depth=self._depth if vector else self.parameters.node_rows)
        self._m.submodules[name] = ram
        address = self._later(self._place if vector else self._row, arrival - READ_LATENCY - 1 - self._early(arrival))
        host, by_host = self._host(""), self._host_place() if vector else self._host("index")
        registered_ports(self._m, ram, name, host, {"address": by_host}, {"address": address})
        return ram

    def _written(self, name: str, ram: BlockRam, *, vector: bool = True, **writers):
        """What is written: a strobe and a word of each who writes, ``by_host`` or ``own``."""
        places = {
            "by_host": self._host_place() if vector else self._host("index"),
            "own": self._later(self._place, self.datapath.done),
        }
        ports = {"by_host": {}, "own": {}}
        for who, (strobe, word) in writers.items():
            ports[who] = {"write": strobe, "write_address": places[who], "write_data": word}
        registered_ports(self._m, ram, name, self._host(""), **ports)

    def _memories(self, inputs):
        memories, arrival, axes = {}, self.schedule.arrival, self.datapath.axes
        for quantity, q in records.node_state(self.parameters.formats).items():
            for axis in axes:
                name = f"{quantity}_{axis}"
                memories[name] = ram = self._memory(f"node_{name}", q.width, arrival[name])
                inputs[name] = self._near(name, ram, q)
        strobes = dict(zip(AXES, self._host("write_load"), strict=True))
        for axis in axes:
            q = self.parameters.formats.accumulator
            memories[f"load_{axis}"] = ram = self._memory(f"load_{axis}", q.width, arrival[f"load_{axis}"])
            inputs[f"load_{axis}"] = self._near(f"load_{axis}", ram, q)
            self._written(f"load_{axis}", ram, by_host=(self._any(strobes, axis), self._host("data")))
        for axis in AXES:
            self._m.d.comb += getattr(self, f"host_load_{axis}").eq(memories[f"load_{self._of(axis)}"].data)
        parts, host = self._mass.unpack(self._host("data")), self._mass.unpack(self.host_mass)
        for part, q in self._mass.items():
            name = f"inverse_mass_{part}"
            ram = self._memory(name, q.width, arrival[name], vector=False)
            inputs[name] = self._near(name, ram, q)
            self._written(name, ram, vector=False, by_host=(self._host("write_mass"), parts[part]))
            self._m.d.comb += host[part].eq(ram.data)
        return memories

    def _of(self, axis: str) -> str:
        """What the component of an axis is called in the pipeline."""
        return axis if axis in self.datapath.axes else IN_TURN[0]

    def _any(self, bits: dict, axis: str):
        """Of bits by axis, that of a component of the pipeline: of the axis, or of any."""
        return bits[axis] if axis in bits else Cat(*bits.values()).any()

    def _near(self, name: str, ram: BlockRam, q):
        """A memory's word when the pipeline needs it, where there is time for it from a register: the place of a memory
        is given."""
        word = Signal(shape(q), name=f"near_{name}", reset_less=True)
        self._m.d["sync" if self._early(self.schedule.arrival[name]) else "comb"] += word.eq(ram.data)
        return word

    def _early(self, arrival: int) -> bool:
        """Whether a word that is needed then can be read a cycle before."""
        return self._gathered + arrival - READ_LATENCY - 1 > 0

    def _write_back(self, pipe, memories):
        m, done, axes, turns = self._m, self.datapath.done, self.datapath.axes, self.datapath.cycles_per_node
        valid, last = self._later(self._valid, done), self._later(self._stage["stage_last"], done)
        strobes = dict(zip(NODE_WORDS, self._host("write_state"), strict=True))
        for quantity, result in RESULTS.items():
            for axis in axes:
                by_host = {}
                if quantity in ("x_base", "v_base", "v"):
                    whose = {each: strobes[f"{quantity[0]}_{each}"] for each in AXES}
                    by_host["by_host"] = self._any(whose, axis), self._host("data")
                own = valid & last if "base" in quantity else valid, pipe.output(f"{result}_{axis}", done)
                name = f"{quantity}_{axis}"
                self._written(f"node_{name}", memories[name], own=own, **by_host)
        for word in NODE_WORDS:
            quantity, axis = word.split("_")
            waits = AXES[::-1].index(axis) if turns > 1 else 0  # for the last of them
            m.d.comb += getattr(self, f"update_{word}").eq(pipe.output(f"{quantity}_{self._of(axis)}", done + waits))
            m.d.comb += getattr(self, f"host_{word}").eq(memories[f"{quantity}_base_{self._of(axis)}"].data)
        m.d.comb += [self.update.eq(self._later(self._last, done)), self.update_row.eq(self._later(self._row, done))]
        forces = {}
        for axis in axes:
            forces[axis] = force = BlockRam(width=self.parameters.formats.state, depth=self._depth)
            m.submodules[f"force_{axis}"] = force
            self._written(f"force_{axis}", force, own=(valid, pipe.output(f"force_{axis}", done)))
            m.d.sync += force.address.eq(self._host_place())
        for axis in AXES:
            m.d.comb += getattr(self, f"host_force_{axis}").eq(forces[self._of(axis)].data)
