"""The edge processor: one edge per cycle, fully pipelined."""

from functools import cached_property

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.graphs import edge_graph
from golden.datapath.tables import inverse_table
from hw.blocks.memory import BlockRam
from hw.machine.interfaces import Named, named
from hw.pipeline.cost import Cost
from hw.pipeline.pipe import Pipe
from hw.pipeline.schedule import Schedule

STATE_SLACK = 16
"""Cycles by which an edge's own words may come later than its force: its nodes are being updated then."""


class EdgeDatapath:
    """`golden.datapath.graphs.edge_graph` with its schedule.

    Only the positions of the two nodes come with the edge; velocities, materials and the edge's state are read when
    they are needed.
    """

    def __init__(self, formats: Formats, tables: int, cost: Cost):
        self.formats, self.tables, self.cost = formats, tables, cost

    @cached_property
    def graph(self):
        return edge_graph(self.formats, self.tables)

    @cached_property
    def schedule(self):
        late = {name for name in self.graph.inputs if name.startswith(("i_v", "j_v", "material_", "edge_", "stage_"))}
        pulls = {name for name in self.graph.outputs if name.startswith("pull_")}
        return Schedule(
            self.graph, self.cost, late=late, static={"velocity_shift"}, critical_outputs=pulls, slack=STATE_SLACK
        )

    @cached_property
    def faults(self) -> list[str]:
        """The names of all faults that the datapath can report, sorted."""
        return self.graph.fault_names

    def ready(self, output: str) -> int:
        """Return the cycle in which an output is valid, counted from that of the nodes; it comes from a register."""
        node = self.graph.outputs[output]
        return self.schedule.cycle[node] + (self.schedule.start[node] == self.schedule.cycle[node])


class EdgeProcessor(wiring.Component):
    """`golden.datapath.edge.edge` as a pipeline.

    Throughput one edge per cycle, always; nothing stalls it. The two positions and ``valid`` are taken in cycle 0,
    every other input in the cycle ``datapath.schedule.arrival[name]``; an output is valid in cycle
    ``datapath.ready(name)``.

    Parameters
    ----------
    datapath : EdgeDatapath

    Members
    -------
    reset : In(1)
        The circuit's reset, from a register near by; it clears what is valid, and the faults.
    valid : In(1)
    inputs : In(Named), outputs : Out(Named)
        Of the graph.
    fault : Out
        One bit for each name in ``datapath.faults``: 1 when it has happened to a valid edge,
        `hw.pipeline.pipe.FAULT_LATENCY` cycles before.
    table_write, table_address, table_data : In
        Writes a word of the damper tables; only while no edge is under way.
    table_read : In(1), table_word : Out
        While ``table_read`` is 1 the pipeline's port reads the word at ``table_address`` instead.
    """

    def __init__(self, datapath: EdgeDatapath):
        self.datapath = datapath
        fmt, graph = datapath.formats, datapath.graph
        self._depth = datapath.tables << fmt.damper_index.width
        self._word = records.damper_word(fmt).width
        address = max(1, (self._depth - 1).bit_length())
        super().__init__(
            {
                "reset": In(1),
                "valid": In(1),
                "inputs": In(Named(graph.inputs)),
                "outputs": Out(Named(graph.outputs)),
                "fault": Out(len(datapath.faults)),
                "table_write": In(2),
                "table_address": In(address),
                "table_data": In(self._word // 2),
                "table_read": In(1),
                "table_word": Out(self._word),
            }
        )

    def elaborate(self, platform):
        m = Module()
        tables = {"inverse": self._inverse(m), "damper": self._damper(m)}
        pipe = Pipe(m, self.datapath.schedule, named(self.inputs), self.valid, tables, reset=self.reset)
        for name, port in named(self.outputs).items():
            m.d.comb += port.eq(pipe.output(name, self.datapath.ready(name)))
        m.d.comb += self.fault.eq(Cat(pipe.faults[name] for name in self.datapath.faults))
        pipe.build()
        return m

    def _inverse(self, m):
        fmt = self.datapath.formats
        word, contents = records.inverse_word(fmt), inverse_table(fmt)
        columns = zip(*contents.values(), strict=True)
        rows = [word.pack(dict(zip(contents, column, strict=True))) for column in columns]

        def lookup(index):
            m.submodules.inverse_table = rom = BlockRam(width=word.width, depth=len(rows), init=rows)
            m.d.comb += rom.address.eq(index)
            return rom.data

        return lookup

    def _damper(self, m):
        """Two memories, because a word of rho and sigma is two block-RAM words long."""

        def lookup(table, index):
            address = Signal(len(self.table_address), name="damper_address")
            m.d.comb += address.eq(Cat(index, table))
            with m.If(self.table_read):
                m.d.comb += address.eq(self.table_address)
            words = []
            for half, name in enumerate(("rho", "sigma")):
                m.submodules[f"{name}_table"] = ram = BlockRam(width=self._word // 2, depth=self._depth)
                m.d.comb += [
                    ram.write.eq(self.table_write[half]),
                    ram.write_address.eq(self.table_address),
                    ram.write_data.eq(self.table_data),
                    ram.address.eq(address),
                ]
                words.append(ram.data)
            m.d.comb += self.table_word.eq(Cat(*words))
            return self.table_word

        return lookup
