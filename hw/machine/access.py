"""The host's access to the memories of lanes, node updaters and lists."""

from amaranth.hdl import Array, Cat, Module, Signal

from golden.numbers.graph import AXES
from hw.machine.interfaces import MemoryAccess, named
from hw.machine.routes import CHOICE, HANDOVER, MEMORY, PORT
from hw.map.memory_map import NODE_FORCE, NODE_LOAD, NODE_STATE, Map, Region
from hw.parameters import Parameters
from hw.pipeline.choice import choose
from hw.pipeline.delay import DelayLines


class Access:
    """Connections between the host port and all that it reads and writes, written into a module.

    Parameters
    ----------
    m : Module
    lines : DelayLines
    parameters : Parameters
    memories : MemoryAccess
        The host port's.
    idle, loading : Value
        1 while the host has the memories of lanes and updaters; 1 while it has those of the lists.
    """

    def __init__(self, m: Module, lines: DelayLines, parameters: Parameters, memories: MemoryAccess, idle, loading):
        self._m, self._lines, self._parameters, self._memories = m, lines, parameters, memories
        self._idle, self._loading, self._words = idle, loading, named(memories.words)
        self._index = Signal.like(memories.index, name="host_index")
        self._data = Signal.like(memories.data, name="host_data")
        m.d.sync += [self._index.eq(memories.index), self._data.eq(memories.data)]
        self._strobes = {}

    def to_nodes(self, updaters, lists):
        """Connect updaters (`hw.machine.interfaces.UpdaterAccess`) and their lists
        (`hw.machine.interfaces.EntryAccess`)."""
        m, p = self._m, self._parameters
        row, column = p.node_address(self._index)
        if p.cycles_per_node > 1:
            axis = self._axis()
            m.d.comb += [host.axis.eq(axis) for host in updaters]
        entry_strobe = self._strobe(Region.NODE, Map(p).words(Region.NODE).index("entry"))
        nodes = []
        for number, (host, entries) in enumerate(zip(updaters, lists, strict=True)):
            m.d.comb += [
                host.active.eq(self._idle),
                host.index.eq(row),
                host.data.eq(self._data),
                host.write.state.eq(self._node_strobes(NODE_STATE, number)),
                host.write.load.eq(self._node_strobes(NODE_LOAD, number)),
                host.write.mass.eq(self._node_strobes(["inverse_mass"], number)),
            ]
            self._to_list(entries, f"node_entries{number}", row, entry_strobe & (column == number))
            words = named(host.words)
            reads = [words[f"state_{name}"] for name in NODE_STATE] + [words[name] for name in NODE_LOAD]
            reads += [host.words.mass, entries.word, *(words[name] for name in NODE_FORCE)]
            nodes.append(self._chosen(reads, f"node{number}"))
        _, column = p.node_address(self._memories.index)
        m.d.comb += self._words["node"].eq(self._then_chosen(nodes, column, "node"))

    def to_lanes(self, lanes, lists):
        """Connect lanes (`hw.machine.interfaces.LaneAccess`) and their lists (`hw.machine.interfaces.EntryAccess`)."""
        edges, materials, tables = [], [], []
        for number, (host, entries) in enumerate(zip(lanes, lists, strict=True)):
            write = host.write
            self._m.d.comb += [
                host.active.eq(self._idle),
                host.index.eq(self._index),
                host.data.eq(self._data),
                host.field.eq(self._memories.word),
                *(bits.eq(self._node_strobes(NODE_STATE, n)) for n, bits in enumerate(write.node)),
                write.length.eq(self._strobe(Region.EDGE, 1, number)),
                write.ratio.eq(self._strobe(Region.EDGE, 2, number)),
                write.table.eq(Cat(self._strobe(Region.TABLE, 0), self._strobe(Region.TABLE, 1))),
                *(bit.eq(self._strobe(Region.MATERIAL, k)) for k, bit in enumerate(write.material)),
            ]
            self._to_list(entries, f"edge_entries{number}", self._index, self._strobe(Region.EDGE, 0, number))
            edges.append(self._chosen([entries.word, host.words.length, host.words.ratio], f"edge{number}"))
            materials.append(host.words.material)
            half = len(host.words.table) // 2
            tables.append(self._chosen([host.words.table[:half], host.words.table[half:]], f"table{number}"))
        for name, choices in (("edge", edges), ("material", materials), ("table", tables)):
            word = self._then_chosen(choices, self._memories.lane, name)
            self._m.d.comb += self._words[name].eq(word)

    def _to_list(self, entries, name, index, strobe):
        """Connect a list's memory, with as many registers on the route as to the others, those at its ports
        included."""

        def later(value, label):
            return self._lines.later(value, HANDOVER - PORT, name=f"{name}_{label}", reset=label == "write")

        self._m.d.comb += [
            entries.active.eq(self._loading),
            entries.index.eq(later(index, "index")),
            entries.write.eq(later(strobe, "write")),
            entries.data.eq(later(self._data, "data")),
        ]

    def _strobe(self, region: Region, word: int, lane: int | None = None) -> Signal:
        """Return the strobe of the host's writes to a word, of one lane if given, from a register."""
        if (region, word, lane) not in self._strobes:
            here = self._memories.strobe[region] & (self._memories.word == word)
            strobe = Signal(name=f"write_{region.name.lower()}_{word}" + ("" if lane is None else f"_{lane}"))
            self._m.d.sync += strobe.eq(here if lane is None else here & (self._memories.lane == lane))
            self._strobes[region, word, lane] = strobe
        return self._strobes[region, word, lane]

    def _node_strobes(self, names, number):
        words = Map(self._parameters).words(Region.NODE)
        _, column = self._parameters.node_address(self._index)
        return Cat(self._strobe(Region.NODE, words.index(name)) & (column == number) for name in names)

    def _axis(self) -> Signal:
        """Return the axis of the addressed node word, aligned with the index."""
        suffixes = (word.rpartition("_")[2] for word in Map(self._parameters).words(Region.NODE))
        numbers = Array([AXES.index(suffix) if suffix in AXES else 0 for suffix in suffixes])
        axis = Signal(range(len(AXES)), name="host_axis")
        self._m.d.sync += axis.eq(numbers[self._memories.word])
        return axis

    def _chosen(self, words, name):
        """Return the addressed word of one lane or updater, `CHOICE` cycles after the words."""
        return choose(self._m, self._lines, words, self._memories.word, cycles=CHOICE, name=name, ahead=MEMORY)

    def _then_chosen(self, words, index, name):
        """Return the word of the addressed lane or updater, `CHOICE` cycles later still."""
        return choose(self._m, self._lines, words, index, cycles=CHOICE, name=name, ahead=MEMORY + CHOICE)
