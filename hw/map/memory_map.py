"""The memory map: one table that the circuit, its driver, the manifest and the documentation read."""

from dataclasses import dataclass
from enum import IntEnum

from golden.datapath import records
from golden.numbers.graph import AXES
from golden.numbers.qformat import unsigned
from golden.numbers.record import Record
from hw.parameters import Parameters

ADDRESS = Record({"index": unsigned(16, 0), "word": unsigned(5, 0), "lane": unsigned(3, 0), "region": unsigned(3, 0)})
"""A host address."""

MAGIC = int.from_bytes(b"RHEO")
VERSION = 1


class Region(IntEnum):
    CONTROL = 0
    NODE = 1
    EDGE = 2
    MATERIAL = 3
    TABLE = 4


class Control(IntEnum):
    """Index of a control register."""

    MAGIC = 0
    VERSION = 1
    LANES = 2
    UPDATES = 3
    NODES = 4
    ROWS = 5
    MATERIALS = 6
    TABLES = 7
    BUSY = 8
    CYCLES = 9
    ROWS_ISSUED = 10
    EDGES_ISSUED = 11
    NODE_WAITS = 12
    LIST_WAITS = 13
    END_WAITS = 14
    STEPS_DONE = 15
    FAULTS = 16
    REFUSED = 17
    ROW_COUNT = 18
    NODE_COUNT = 19
    VELOCITY_SHIFT = 20
    RUN = 21
    STOP = 22


READ_ONLY = frozenset(control for control in Control if control <= Control.STEPS_DONE)

CONTROL_TEXT = {
    Control.MAGIC: "`RHEO`",
    Control.VERSION: "of this map",
    Control.LANES: "edge processors",
    Control.UPDATES: "nodes updated per cycle",
    Control.NODES: "capacity",
    Control.ROWS: "capacity: edges of each lane",
    Control.MATERIALS: "capacity",
    Control.TABLES: "capacity: damper tables",
    Control.BUSY: "1 while steps are run",
    Control.CYCLES: "of the last run",
    Control.ROWS_ISSUED: "in the last run: cycles in which the lanes took a row of edges",
    Control.EDGES_ISSUED: "in the last run: a list's last row may lack some",
    Control.NODE_WAITS: "cycles of the last run in which a row waited for its nodes to be updated",
    Control.LIST_WAITS: "cycles of the last run in which the list of rows had not been read yet",
    Control.END_WAITS: "cycles of the last run after its last row; with rows issued and the other waits all cycles",
    Control.STEPS_DONE: "in the last run",
    Control.FAULTS: "sticky, a bit for each name of the manifest; a 1 that is written clears it",
    Control.REFUSED: "requests refused; any write clears it",
    Control.ROW_COUNT: "rows of edges in use, at least 1",
    Control.NODE_COUNT: "nodes in use, at least 1",
    Control.VELOCITY_SHIFT: "the velocity full scale is 2^-this sizes per step",
    Control.RUN: "a write runs so many steps, at least 1",
    Control.STOP: "any write ends the run with its step or the next; then `STEPS_DONE` says how many were done",
}

COUNTERS = {control: control.name.lower() for control in Control if Control.CYCLES <= control <= Control.END_WAITS}
"""What the machine counts in a run, and the names of the counters' ports."""

NODE_STATE = tuple(f"{quantity}_{axis}" for quantity in "xv" for axis in AXES)
NODE_LOAD = tuple(f"load_{axis}" for axis in AXES)
NODE_FORCE = tuple(f"force_{axis}" for axis in AXES)
NODE_WORDS = (*NODE_STATE, *NODE_LOAD, "inverse_mass", "entry", *NODE_FORCE)
EDGE_WORDS = ("entry", "length", "ratio")
TABLE_WORDS = ("rho", "sigma")


@dataclass(frozen=True)
class Map:
    """Words and depth of each region for a circuit's capacities."""

    parameters: Parameters

    def words(self, region: Region) -> tuple[str, ...]:
        if region == Region.MATERIAL:
            return tuple(records.material(self.parameters.formats, self.parameters.tables))
        names = {Region.CONTROL: ("register",), Region.NODE: NODE_WORDS, Region.EDGE: EDGE_WORDS}
        return names.get(region, TABLE_WORDS)

    def depth(self, region: Region) -> int:
        p = self.parameters
        return {
            Region.CONTROL: len(Control),
            Region.NODE: p.nodes,
            Region.EDGE: p.rows,
            Region.MATERIAL: p.materials,
            Region.TABLE: p.tables << p.formats.damper_index.width,
        }[region]

    def fields(self, region: Region, word: str) -> Record:
        """What a word holds, lowest bits first."""
        fmt, tables = self.parameters.formats, self.parameters.tables
        if region == Region.CONTROL:
            return Record({"value": unsigned(fmt.state, 0)})
        if word == "entry":
            return records.node_entry() if region == Region.NODE else records.edge_entry()
        if word == "inverse_mass":
            return records.inverse_mass(fmt)
        if region == Region.TABLE:
            return records.damper_word(fmt).starting_with(word)
        node = {"x": fmt.position, "v": fmt.velocity, "load": fmt.accumulator, "force": fmt.accumulator}
        edge = {"length": fmt.length, "ratio": fmt.ratio}
        formats = {
            Region.NODE: {name: node[name.split("_")[0]] for name in NODE_STATE + NODE_LOAD + NODE_FORCE},
            Region.EDGE: edge,
            Region.MATERIAL: records.material(fmt, tables),
        }
        return Record({"value": formats[region][word]})

    def mask(self, address: int) -> int:
        """The bits of a word that are there to be read back: those of its fields."""
        region = Region(ADDRESS.field("region", address))
        word = self.words(region)[ADDRESS.field("word", address)]
        return (1 << self.fields(region, word).width) - 1

    def read_only(self, region: Region, word: str) -> bool:
        return region == Region.NODE and word in NODE_FORCE

    def lanes(self, region: Region) -> int:
        """How many lanes an address of the region may name; a write to materials and tables goes to all."""
        return 1 if region in (Region.CONTROL, Region.NODE) else self.parameters.lanes

    def address(self, region: Region, word: int | str = 0, index: int = 0, lane: int = 0) -> int:
        """Raises ValueError if the map has no such place."""
        number = self.words(region).index(word) if isinstance(word, str) else word
        limits = {"word": len(self.words(region)), "index": self.depth(region), "lane": self.lanes(region)}
        for name, value in (("word", number), ("index", index), ("lane", lane)):
            if not 0 <= value < limits[name]:
                raise ValueError(f"{region.name} {name} must be below {limits[name]}, not {value}")
        return join(region, number, index, lane)


def join(region: int, word: int, index: int, lane: int) -> int:
    """Return the address."""
    return ADDRESS.pack({"index": index, "word": word, "lane": lane, "region": region})
