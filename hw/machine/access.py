"""The host's access to the memories of lanes, node updaters and lists."""

from functools import cached_property

from amaranth.hdl import Array, Cat, Module, Signal

from golden.numbers.graph import AXES
from hw.machine.host_port import CHOICE, MEMORY, HostPort
from hw.map.memory_map import NODE_FORCE, NODE_LOAD, NODE_STATE, Map, Region
from hw.parameters import Parameters
from hw.pipeline.choice import choose
from hw.pipeline.delay import DelayLines


class Access:
    """Connections between a `hw.machine.host_port.HostPort` and all that it writes and reads, written into a module.

    Attributes
    ----------
    index, data : Signal
        Of the access that is going on, from registers: with `strobe`.
    """

    def __init__(self, m: Module, lines: DelayLines, parameters: Parameters, host: HostPort):
        self._m, self._lines, self._parameters, self._host = m, lines, parameters, host
        self.index, self.data = Signal.like(host.index), Signal.like(host.data)
        m.d.sync += [self.index.eq(host.index), self.data.eq(host.data)]
        self._strobes = {}

    def strobe(self, region: Region, word: int, lane: int | None = None) -> Signal:
        """A write of the host to such a word, of such a lane, from a register."""
        if (region, word, lane) not in self._strobes:
            here = self._host.strobe[region] & (self._host.word == word)
            strobe = Signal(name=f"write_{region.name.lower()}_{word}" + ("" if lane is None else f"_{lane}"))
            self._m.d.sync += strobe.eq(here if lane is None else here & (self._host.lane == lane))
            self._strobes[region, word, lane] = strobe
        return self._strobes[region, word, lane]

    def to_nodes(self, updaters, entries, idle):
        """A node's memories, in the updater that has it; ``entries``: of the updaters' lists."""
        row, column = self._parameters.node_place(self.index)
        nodes = []
        for number, (updater, entry) in enumerate(zip(updaters, entries, strict=True)):
            self._m.d.comb += [
                updater.host.eq(idle),
                updater.host_index.eq(row),
                updater.host_data.eq(self.data),
                updater.host_write_state.eq(self._node_strobes(NODE_STATE, number)),
                updater.host_write_load.eq(self._node_strobes(NODE_LOAD, number)),
                updater.host_write_mass.eq(self._node_strobes(["inverse_mass"], number)),
            ]
            if self._parameters.cycles_per_node > 1:
                self._m.d.comb += updater.host_axis.eq(self._axis)
            reads = [getattr(updater, f"host_{name}") for name in (*NODE_STATE, *NODE_LOAD)]
            reads += [updater.host_mass, entry, *(getattr(updater, f"host_{name}") for name in NODE_FORCE)]
            nodes.append(self._chosen(reads, f"node{number}"))
        column = self._parameters.node_place(self._host.index)[1]
        self._m.d.comb += self._host.node_word.eq(self._then_chosen(nodes, column, "node"))

    @cached_property
    def _axis(self):
        """That of a node's word, beside its index."""
        suffixes = (word.rpartition("_")[2] for word in Map(self._parameters).words(Region.NODE))
        numbers = Array([AXES.index(suffix) if suffix in AXES else 0 for suffix in suffixes])
        axis = Signal(range(len(AXES)), name="host_axis")
        self._m.d.sync += axis.eq(numbers[self._host.word])
        return axis

    def _node_strobes(self, names, number):
        words = Map(self._parameters).words(Region.NODE)
        _, column = self._parameters.node_place(self.index)
        return Cat(self.strobe(Region.NODE, words.index(name)) & (column == number) for name in names)

    def to_lanes(self, lanes, entries, idle):
        """A lane's memories; ``entries``: of the lanes' lists."""
        edges, materials, tables = [], [], []
        for number, (lane, entry) in enumerate(zip(lanes, entries, strict=True)):
            updates = range(self._parameters.updates)
            self._m.d.comb += [
                lane.host.eq(idle),
                lane.host_index.eq(self.index),
                lane.host_data.eq(self.data),
                *(getattr(lane, f"host_write_node{n}").eq(self._node_strobes(NODE_STATE, n)) for n in updates),
                lane.host_write_length.eq(self.strobe(Region.EDGE, 1, number)),
                lane.host_write_ratio.eq(self.strobe(Region.EDGE, 2, number)),
                lane.host_write_table.eq(Cat(self.strobe(Region.TABLE, 0), self.strobe(Region.TABLE, 1))),
                lane.host_field.eq(self._host.word),
                *(bit.eq(self.strobe(Region.MATERIAL, k)) for k, bit in enumerate(lane.host_write_material)),
            ]
            edges.append(self._chosen([entry, lane.host_length, lane.host_ratio], f"edge{number}"))
            materials.append(lane.host_material)
            half = len(lane.host_table) // 2
            tables.append(self._chosen([lane.host_table[:half], lane.host_table[half:]], f"table{number}"))
        for name, choices in (("edge", edges), ("material", materials), ("table", tables)):
            word = self._then_chosen(choices, self._host.lane, name)
            self._m.d.comb += getattr(self._host, f"{name}_word").eq(word)

    def _chosen(self, words, name):
        """The word that is read, of one lane or updater."""
        return choose(self._m, self._lines, words, self._host.word, cycles=CHOICE, name=name, ahead=MEMORY)

    def _then_chosen(self, words, index, name):
        """Of all lanes' or updaters' words, a choice later."""
        return choose(self._m, self._lines, words, index, cycles=CHOICE, name=name, ahead=MEMORY + CHOICE)
