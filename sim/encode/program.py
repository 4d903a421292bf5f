"""The program of a circuit: the writes that load an image, with each edge's lane and row and each node's updater."""

from collections.abc import Iterator

import numpy as np

from golden.datapath import records
from golden.datapath.memory_image import MemoryImage
from golden.scene.capacity import max_edges_at_node
from golden.support.errors import InputError
from hw.map.control import Control
from hw.map.memory_map import NODE_LOAD, NODE_STATE, Map, Region
from hw.parameters import Parameters

Write = tuple[int, int]
"""(address, data)"""


class Program:
    """The writes that load an image into a circuit. Edge e goes to lane ``e % lanes``, row ``e // lanes``; node n to
    updater ``n % updates``, row ``n // updates``.

    Raises
    ------
    InputError
        If the circuit is too small for the image, or made for other formats, or a node has too many edges.
    """

    def __init__(self, image: MemoryImage, parameters: Parameters):
        self.image, self.parameters, self._map = image, parameters, Map(parameters)
        self.rows = -(-len(image.edges) // parameters.lanes)
        for name, used, room in (
            ("nodes", image.nodes, parameters.nodes),
            ("edges", len(image.edges), parameters.lanes * parameters.rows),
            ("materials", len(image.materials), parameters.materials),
            ("tables", len(image.damper["rho_value"]), parameters.tables),
        ):
            if used > room:
                raise InputError(f"{name} of the object must be at most {room} for this circuit, not {used}")
        busiest, most = np.bincount(image.edges.ravel()).max(), max_edges_at_node(image.formats)
        if busiest > most:
            raise InputError(f"edges at one node must be at most {most}, so that no sum overflows, not {busiest}")
        if image.formats != parameters.formats:
            raise InputError(f"formats of the object must be the circuit's {parameters.formats}, not {image.formats}")

    def load(self) -> Iterator[Write]:
        """Yield all writes but those of `start`."""
        yield from self._control()
        yield from self.materials()
        yield from self._entries()

    def materials(self) -> Iterator[Write]:
        """Yield the writes that change materials: coefficients, damper tables, natural lengths and ratios."""
        yield from self._materials()
        yield from self._tables()
        yield from self._edges()

    def start(self, v: np.ndarray, x: np.ndarray | None = None) -> Iterator[Write]:
        """Yield the writes that start a phase: velocities, loads and masses; positions too if given."""
        image, mass = self.image, records.inverse_mass(self.parameters.formats)
        columns = [*zip(NODE_LOAD, image.load.T, strict=True), *zip(NODE_STATE[3:], v.T, strict=True)]
        columns += zip(NODE_STATE[:3], x.T, strict=True) if x is not None else []
        for name, column in columns:
            yield from self._column(Region.NODE, name, column)
        yield from self._column(Region.NODE, "inverse_mass", mass.pack(image.inverse_mass))

    def need(self) -> np.ndarray:
        """Return (node rows,) the rows of edges that have to be summed before a row of nodes may be updated."""
        need = np.zeros(-(-self.image.nodes // self.parameters.updates), np.int64)
        rows = np.arange(len(self.image.edges)) // self.parameters.lanes
        np.maximum.at(need, self.image.edges // self.parameters.updates, rows[:, None] + 1)
        return need

    def highest(self) -> np.ndarray:
        """Return (rows,) the last row of nodes that an edge of the row reads."""
        highest = np.zeros(self.rows, np.int64)
        rows = np.arange(len(self.image.edges)) // self.parameters.lanes
        np.maximum.at(highest, rows, self.image.edges.max(axis=1) // self.parameters.updates)
        return highest

    def edge_addresses(self, word: str) -> list[int]:
        """Return the address of a word of each edge."""
        return [self._address(Region.EDGE, word, *self._row_and_lane(e)) for e in range(len(self.image.edges))]

    def node_addresses(self, word: str) -> list[int]:
        """Return the address of a word of each node."""
        return [self._address(Region.NODE, word, n) for n in range(self.image.nodes)]

    def _address(self, region, word, index, lane=0):
        return self._map.address(region, word, index, lane)

    def _row_and_lane(self, edge: int) -> tuple[int, int]:
        """Return (row, lane) of an edge."""
        return edge // self.parameters.lanes, edge % self.parameters.lanes

    def _word(self, raw) -> int:
        return int(raw) & (1 << self.parameters.formats.state) - 1

    def _column(self, region, name, values):
        for index, value in enumerate(values):
            yield self._address(region, name, index), self._word(value)

    def _control(self):
        image = self.image
        for register, value in (
            (Control.ROW_COUNT, self.rows),
            (Control.NODE_COUNT, image.nodes),
            (Control.VELOCITY_SHIFT, image.velocity_shift),
        ):
            yield self._address(Region.CONTROL, 0, register), value

    def _materials(self):
        for number, fields in enumerate(self.image.materials):
            for name, value in fields.items():
                yield self._address(Region.MATERIAL, name, number), self._word(value)

    def _tables(self):
        words = records.damper_word(self.parameters.formats)
        for quantity in ("rho", "sigma"):
            packed = words.starting_with(quantity).pack(self.image.damper).ravel()
            yield from self._column(Region.TABLE, quantity, packed)

    def _edges(self):
        image = self.image
        for word, values in (("length", image.length), ("ratio", image.ratio)):
            for address, value in zip(self.edge_addresses(word), values, strict=True):
                yield address, self._word(value)

    def _entries(self):
        """Yield the entries of the edge and node lists: see `golden.datapath.records`."""
        image, lanes, updates = self.image, self.parameters.lanes, self.parameters.updates
        need = np.repeat(self.need(), updates)
        mask = np.zeros(len(need), int)
        for number in range(self.rows * lanes):
            row, lane = self._row_and_lane(number)
            fields = dict.fromkeys(records.edge_entry(), 0)
            if number < len(image.edges):
                fields |= {"valid": 1, "material": image.edge_material[number]}
                for half, (end, n) in enumerate(zip("ij", image.edges[number], strict=True)):
                    bank = 1 << half * lanes + lane
                    fields |= {end: n, f"{end}_first": int(not mask[n] & bank)}
                    mask[n] |= bank
            yield self._address(Region.EDGE, "entry", row, lane), records.edge_entry().pack(fields)
        for n in range(len(need)):
            fields = {"need": need[n], "mask": mask[n], "valid": int(n < image.nodes)}
            entry = records.node_entry().pack(fields)
            yield self._address(Region.NODE, "entry", n), entry
