"""Who answers a greeting: the circuit, in items."""

from __future__ import annotations

from dataclasses import astuple, dataclass, fields

from golden.datapath.formats import Formats
from hw.link.frame import KEY_BYTES
from hw.link.protocol import VERSION as PROTOCOL
from hw.map.memory_map import MAGIC, VERSION
from hw.parameters import Parameters

PART = KEY_BYTES // 2
"""Bytes of the key in an item."""

IDENTITY_TEXT = (
    ("magic", "`RHEO`"),
    ("protocol", "version of what is said over the link"),
    ("map_version", "of the memory map"),
    ("key_low", f"first {PART} bytes of the hash of the memory map, lowest first"),
    ("key_high", f"its other {PART}"),
    ("lanes", "edge processors"),
    ("updates", "nodes updated per cycle"),
    ("nodes", "capacity"),
    ("edges", "capacity"),
    ("materials", "capacity"),
    ("tables", "capacity"),
    ("operand", "bits of a multiplier's operand: the formats follow from it"),
    ("state", "and from this, the bits of a word"),
    ("clock_hz", "clock cycles a second"),
    ("bit_cycles", "clock cycles of a bit on the line"),
)


@dataclass(frozen=True)
class Identity:
    """The items in their order; what they mean is in `IDENTITY_TEXT`."""

    magic: int
    protocol: int
    map_version: int
    key_low: int
    key_high: int
    lanes: int
    updates: int
    nodes: int
    edges: int
    materials: int
    tables: int
    operand: int
    state: int
    clock_hz: int
    bit_cycles: int

    @classmethod
    def of(cls, p: Parameters, key: bytes, clock_hz: int, bit_cycles: int) -> Identity:
        low, high = (int.from_bytes(part, "little") for part in (key[:PART], key[PART:]))
        sizes = (getattr(p, name) for name in p.RANGES)
        return cls(
            MAGIC, PROTOCOL, VERSION, low, high, *sizes, p.formats.operand, p.formats.state, clock_hz, bit_cycles
        )

    @classmethod
    def read(cls, items: list[int]) -> Identity:
        """Raises ValueError for another number of items."""
        if len(items) != len(fields(cls)):
            raise ValueError(f"items must be {len(fields(cls))}, not {len(items)}")
        return cls(*items)

    @property
    def items(self) -> list[int]:
        return list(astuple(self))

    @property
    def key(self) -> bytes:
        return b"".join(part.to_bytes(PART, "little") for part in (self.key_low, self.key_high))

    def parameters(self) -> Parameters:
        """The circuit's, but for the family of its device. Raises ValueError if there can't be such a circuit."""
        return Parameters(
            **{name: getattr(self, name) for name in Parameters.RANGES}, formats=Formats(self.operand, self.state)
        )


assert tuple(field.name for field in fields(Identity)) == tuple(name for name, _ in IDENTITY_TEXT)
