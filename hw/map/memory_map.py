"""The memory map, one table for the circuit, its driver, the manifest and the documentation."""

from dataclasses import dataclass
from enum import IntEnum

from golden.datapath import records
from golden.numbers.graph import AXES
from golden.numbers.qformat import unsigned
from golden.numbers.record import Record
from hw.map.control import Control
from hw.parameters import Parameters

ADDRESS = Record({"index": unsigned(16, 0), "word": unsigned(5, 0), "lane": unsigned(3, 0), "region": unsigned(3, 0)})
"""The fields of a host address."""


class Region(IntEnum):
    CONTROL = 0
    NODE = 1
    EDGE = 2
    MATERIAL = 3
    TABLE = 4


NODE_STATE = tuple(f"{quantity}_{axis}" for quantity in "xv" for axis in AXES)
NODE_LOAD = tuple(f"load_{axis}" for axis in AXES)
NODE_FORCE = tuple(f"force_{axis}" for axis in AXES)
NODE_WORDS = (*NODE_STATE, *NODE_LOAD, "inverse_mass", "entry", *NODE_FORCE)
EDGE_WORDS = ("entry", "length", "ratio")
TABLE_WORDS = ("rho", "sigma")


@dataclass(frozen=True)
class Map:
    """The regions of a circuit's memory: their words, fields and depths."""

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
        """Return the fields of a word, lowest bits first."""
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
        """Return a mask of the bits of a word that a read gives back: those of its fields."""
        region = Region(ADDRESS.field("region", address))
        word = self.words(region)[ADDRESS.field("word", address)]
        return (1 << self.fields(region, word).width) - 1

    def read_only(self, region: Region, word: str) -> bool:
        return region == Region.NODE and word in NODE_FORCE

    def lanes(self, region: Region) -> int:
        """Return the number of lanes that an address may name. Writes of materials and tables go to all lanes."""
        return 1 if region in (Region.CONTROL, Region.NODE) else self.parameters.lanes

    def address(self, region: Region, word: int | str = 0, index: int = 0, lane: int = 0) -> int:
        """Return an address. Raises ValueError if nothing is there."""
        number = self.words(region).index(word) if isinstance(word, str) else word
        limits = {"word": len(self.words(region)), "index": self.depth(region), "lane": self.lanes(region)}
        for name, value in (("word", number), ("index", index), ("lane", lane)):
            if not 0 <= value < limits[name]:
                raise ValueError(f"{region.name} {name} must be below {limits[name]}, not {value}")
        return join(region, number, index, lane)


def join(region: int, word: int, index: int, lane: int) -> int:
    """Return the address with these fields."""
    return ADDRESS.pack({"index": index, "word": word, "lane": lane, "region": region})
