"""A lane: an edge processor, the memories of its edges, its copy of the nodes and its sums of forces."""

from amaranth.hdl import Array, Cat, Module, Mux, ResetSignal, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath import records
from golden.numbers.graph import AXES
from hw.blocks.memory import READ_LATENCY, BlockRam, LutRam
from hw.machine.accumulator import ANNOUNCED, WRITTEN, Accumulator
from hw.machine.edge import EdgeDatapath, EdgeProcessor
from hw.machine.host_port import CHOICE, HANDOVER, MEMORY, registered_ports
from hw.machine.issue_register import IssueRegister
from hw.parameters import Parameters
from hw.pipeline.choice import choose
from hw.pipeline.delay import DelayLines
from hw.pipeline.operations import shape

NODE_WORDS = tuple(f"{quantity}_{axis}" for quantity in "xv" for axis in AXES)
EDGE_WORDS = ("length", "base", "ratio", "total")
NEXT = {"base": "base_next", "ratio": "ratio_next", "total": "total_next"}


FETCHED = READ_LATENCY + 1
"""Cycles from the issue of an edge to its nodes in registers."""

STAGED = 1
"""Cycles from an edge in front to its Runge-Kutta stage on the lane's ports."""

COPIED = 1
"""Cycles from a node's new state to its copy in a lane's memories: they are far from the node updater."""


def written(datapath: EdgeDatapath, output: str) -> int:
    """Cycles from the issue of an edge to its new word, an output, in the memory."""
    return FETCHED + datapath.ready(output) + 1


def latency(datapath: EdgeDatapath) -> int:
    """Cycles from the issue of an edge to the first in which the sums with its force may be read."""
    return FETCHED + datapath.ready("pull_x") + WRITTEN


def members(parameters: Parameters, datapath: EdgeDatapath) -> dict:
    """The ports of a lane."""
    p, fmt = parameters, parameters.formats
    ends = [(n, end, axis) for n in range(p.updates) for end in "ij" for axis in AXES]
    materials = records.material(fmt, p.tables)
    node_formats = {"x": fmt.position, "v": fmt.velocity}
    return {
        "flush": In(1),
        "row_behind": In(p.row_bits),
        "edge_behind": In(records.edge_entry().width),
        "node_behind": In(p.node_row_bits),
        **{f"{name}_{port}": In(1) for name in ("row", "node") for port in ("behind_valid", "behind_ready", "ready")},
        **{f"stage_{bit}": In(1) for bit in ("first", "last", "half", "double")},
        "velocity_shift": In(shape(fmt.exponent)),
        "update_row": In(p.node_row_bits),
        **{f"update{n}": In(1) for n in range(p.updates)},
        **{f"update{n}_{word}": In(shape(node_formats[word[0]])) for n in range(p.updates) for word in NODE_WORDS},
        **{f"sum{n}_{end}_{axis}": Out(shape(fmt.accumulator)) for n, end, axis in ends},
        "fault": Out(len(datapath.faults)),
        "host": In(1),
        "host_index": In(p.index_bits),
        "host_data": In(p.formats.state),
        **{f"host_write_node{n}": In(len(NODE_WORDS)) for n in range(p.updates)},
        "host_write_length": In(1),
        "host_write_ratio": In(1),
        "host_write_material": In(len(materials)),
        "host_write_table": In(2),
        "host_field": In(range(len(materials))),
        "host_length": Out(fmt.state),
        "host_ratio": Out(fmt.state),
        "host_material": Out(fmt.state),
        "host_table": Out(2 * fmt.operand * 2),
    }


class Lane(wiring.Component):
    """Takes an edge per cycle: reads its nodes and its own state, processes it, adds its force to both nodes.

    Latency: the sums of an edge may be read `latency` cycles after it was issued. Throughput one edge per cycle.

    The edge in front and the row of nodes in front stand in the lane itself (`hw.machine.issue_register`), near the
    memories that they are the addresses of; in every lane they move in the same cycles.

    Members
    -------
    flush : In(1)
        Nothing stands in front.
    row_behind, edge_behind : In
        The edge behind the one in front: its place in the lane's memories, its list's entry.
    node_behind : In
        The row of nodes behind the one in front: the sums of the one in front are read.
    row_behind_valid, row_behind_ready, row_ready, node_behind_valid, node_behind_ready, node_ready : In(1)
        As of `hw.machine.issue_register.IssueRegister`.
    stage_first, stage_last, stage_half, stage_double : In(1)
        The Runge-Kutta stage of the edge that was in front `STAGED` cycles before.
    velocity_shift : In
        Static.
    update_row, update<n>, update<n>_x_*, update<n>_v_* : In
        The new states of the nodes of a row, if ``update<n>``; in the lane's memories `COPIED` cycles later.
    sum<n>_i_*, sum<n>_j_* : Out
        The forces summed on the nodes of a row as first and as second ends of edges, `hw.machine.accumulator.READ`
        cycles after it came to the front.
    fault : Out
        One bit for each name in ``datapath.faults``.
    host_* : In / Out
        Reads and writes of the host, only while no edge is under way; see `hw.machine.host_port`.
        ``host_write_node<n>`` has a bit for each of `NODE_WORDS`.
    """

    def __init__(self, parameters: Parameters, datapath: EdgeDatapath):
        self.parameters, self.datapath = parameters, datapath
        self._materials = records.material(parameters.formats, parameters.tables)
        self._state = records.edge_state(parameters.formats)
        super().__init__(members(parameters, datapath))

    def elaborate(self, platform):
        m = Module()
        m.submodules.edge_processor = self._edge = edge = EdgeProcessor(self.datapath)
        self._reset = edge.reset = Signal(name="reset_near", reset_less=True)
        m.d.sync += self._reset.eq(ResetSignal())
        self._m, self._ready, self._arrival = m, self.datapath.ready, self.datapath.schedule.arrival
        self._lines = DelayLines(m)
        self._fronts()
        self._nodes()
        self._edges()
        self._material()
        self._sums()
        m.d.comb += edge.valid.eq(self._later("valid", 0))
        m.d.comb += edge.velocity_shift.eq(self._lines.later(self.velocity_shift, 2))
        for bit in ("first", "last", "half", "double"):
            name = f"stage_{bit}"
            near = Signal(name=f"{name}_near", reset_less=True)
            m.d.sync += near.eq(getattr(self, name))
            later = self._lines.later(near, FETCHED + self._arrival[name] - STAGED - 1, name=name)
            m.d.comb += getattr(edge, name).eq(later)
        for name in ("write", "address", "data", "read"):
            by_host = {"write": "write_table", "address": "index", "read": ""}.get(name, name)
            m.d.sync += getattr(edge, f"table_{name}").eq(self._host(by_host, HANDOVER - 1))
        m.d.comb += self.host_table.eq(edge.table_word)
        fault = Signal.like(self.fault, reset_less=True)  # a reset comes by way of `_reset`
        m.d.sync += fault.eq(Mux(self._reset, 0, edge.fault))
        m.d.comb += self.fault.eq(fault)
        self._lines.build()
        return m

    def _fronts(self):
        """``_issued``: what is taken from the edge in front, by name."""
        fronts = {}
        for name, behind in (("row", Cat(self.edge_behind, self.row_behind)), ("node", self.node_behind)):
            self._m.submodules[f"{name}_front"] = fronts[name] = front = IssueRegister(width=len(behind))
            self._m.d.comb += [front.flush.eq(self.flush), front.behind.eq(behind)]
            for port in ("behind_valid", "behind_ready", "ready"):
                self._m.d.comb += getattr(front, port).eq(getattr(self, f"{name}_{port}"))
        entry, width = fronts["row"].entry, len(self.edge_behind)
        self._issued = records.edge_entry().unpack(entry[:width])
        self._issued["valid"] = self._issued["valid"] & fronts["row"].goes
        for name, bits in (
            ("i", self.parameters.node_bits),
            ("j", self.parameters.node_bits),
            ("material", self.parameters.material_bits),
        ):
            self._issued[name] = self._issued[name][:bits]
        self._issued |= {"row": entry[width:], "sum_row": fronts["node"].entry}

    def _later(self, name: str, cycle: int):
        """What was issued, when its edge is in ``cycle`` of the edge processor; its nodes are read before cycle 0."""
        return self._lines.later(self._issued[name], FETCHED + cycle, name=name, reset=name == "valid")

    def _host(self, name: str, cycles: int = HANDOVER):
        """What comes from the host, which is far: later by as many registers, of which the last may be one behind a
        choice."""
        name = f"host_{name}".rstrip("_")
        return self._lines.later(getattr(self, name), cycles, name=name, reset=True)

    def _nodes(self):
        """Two copies of the nodes' states, one for each end of an edge, each read when the edge processor needs it:
        a node's state stays until all its edges' forces have been summed."""
        p = self.parameters
        written, words = self._copied()
        for end in "ij":
            for number, word in enumerate(NODE_WORDS):
                target, found = getattr(self._edge, f"{end}_{word}"), []
                address = self._arrival.get(target.name, 0) - FETCHED
                row, column = p.node_place(self._later(end, address))
                column = self._lines.later(column, READ_LATENCY, name=f"{target.name}_column")
                for n in range(p.updates):
                    ram = BlockRam(width=len(words[n, word]), depth=p.node_rows)
                    self._m.submodules[f"node_{end}_{word}_{n}"] = ram
                    self._m.d.comb += [
                        ram.write.eq(written[n][number]),
                        ram.write_address.eq(written["row"]),
                        ram.write_data.eq(words[n, word]),
                        ram.address.eq(row),
                    ]
                    found.append(ram.data)
                near = Signal.like(target, name=f"near_{end}_{word}", reset_less=True)
                self._m.d.sync += near.eq(Array(found)[column])
                self._m.d.comb += target.eq(near)

    def _copied(self):
        """(row and strobes, words) in registers: the updaters' new states, or what the host writes."""
        p = self.parameters
        written = {"row": Signal(p.node_row_bits, name="copied_row", reset_less=True)}
        words = {}
        host = self._host("", HANDOVER - 1)
        host_row, _ = p.node_place(self._host("index", HANDOVER - 1))
        self._m.d.sync += written["row"].eq(Mux(host, host_row, self.update_row))
        for n in range(p.updates):
            written[n] = Signal(len(NODE_WORDS), name=f"copied{n}")
            updates = getattr(self, f"update{n}").replicate(len(NODE_WORDS))
            self._m.d.sync += written[n].eq(Mux(host, self._host(f"write_node{n}", HANDOVER - 1), updates))
            for word in NODE_WORDS:
                update = getattr(self, f"update{n}_{word}")
                words[n, word] = copied = Signal.like(update, name=f"copied{n}_{word}", reset_less=True)
                self._m.d.sync += copied.eq(Mux(host, self._host("data", HANDOVER - 1), update))
        return written, words

    def _edges(self):
        """The edges' own words, each read when the edge processor needs it and written when it is done. There is time
        for a register between the memories, whose places are given, and the edge processor."""
        near = {}
        host, index, data = (self._host(name, HANDOVER - 1) for name in ("", "index", "data"))
        host_writes = {"length": self._host("write_length", HANDOVER - 1)}
        host_writes |= dict.fromkeys(("base", "ratio"), self._host("write_ratio", HANDOVER - 1))
        for word in EDGE_WORDS:
            ram = BlockRam(width=self._state[word].width, depth=self.parameters.rows)
            near[word] = Signal(len(ram.data), name=f"near_{word}", reset_less=True)
            self._m.submodules[f"edge_{word}"] = ram
            self._m.d.sync += near[word].eq(ram.data)
            self._m.d.comb += getattr(self._edge, f"edge_{word}").eq(near[word])
            own = {"address": self._later("row", self._arrival[f"edge_{word}"] - READ_LATENCY - 2)}
            if word in NEXT:
                ready = self._ready(NEXT[word])
                own |= {
                    "write": self._later("valid", ready),
                    "write_address": self._later("row", ready),
                    "write_data": getattr(self._edge, NEXT[word]),
                }
            by_host = {}
            if word in host_writes:
                by_host |= {"write": host_writes[word], "write_address": index, "write_data": data}
            if word in ("length", "ratio"):
                by_host["address"] = index
                self._m.d.comb += getattr(self, f"host_{word}").eq(ram.data)
            registered_ports(self._m, ram, f"edge_{word}", host, by_host, own)

    def _material(self):
        """A small memory for each coefficient, read in the cycle before it is needed."""
        words = []
        for number, (name, q) in enumerate(self._materials.items()):
            ram = LutRam(width=q.width, depth=self.parameters.materials)
            self._m.submodules[f"material_{name}"] = ram
            address = self._later("material", self._arrival[f"material_{name}"] - 1)
            self._m.d.comb += [
                ram.address.eq(address),
                ram.write.eq(self._host("write_material")[number]),
                ram.write_address.eq(self._host("index")),
                ram.write_data.eq(self._host("data")),
                getattr(self._edge, f"material_{name}").eq(ram.data),
            ]
            with self._m.If(self._host("")):
                self._m.d.comb += ram.address.eq(self._host("index"))
            words.append(ram.data)
        cycles = READ_LATENCY - 1 + CHOICE  # a small memory is quick, but there are many of them
        word = choose(
            self._m,
            self._lines,
            words,
            self.host_field,
            cycles=cycles,
            name="material_word",
            ahead=MEMORY - READ_LATENCY + 1,
        )
        self._m.d.comb += self.host_material.eq(word)

    def _sums(self):
        p, announce = self.parameters, self._ready("pull_x") - ANNOUNCED
        for end in "ij":
            sums = Accumulator(formats=p.formats, nodes=p.nodes, updates=p.updates, subtract=end == "j")
            self._m.submodules[f"sums_{end}"] = sums
            sums.reset = self._reset
            self._m.d.comb += [
                sums.valid.eq(self._later("valid", announce)),
                sums.node.eq(self._later(end, announce)),
                sums.first.eq(self._later(f"{end}_first", announce)),
                sums.sum_row.eq(self._issued["sum_row"]),
            ]
            for axis in AXES:
                self._m.d.comb += getattr(sums, f"pull_{axis}").eq(getattr(self._edge, f"pull_{axis}"))
                for n in range(p.updates):
                    self._m.d.comb += getattr(self, f"sum{n}_{end}_{axis}").eq(getattr(sums, f"sum{n}_{axis}"))
        ready = {self._ready(f"pull_{axis}") for axis in AXES}
        assert len(ready) == 1, "the components of a force come in the same cycle"
