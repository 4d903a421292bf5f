"""The identity of a circuit: the items of its answer to a greeting."""

from __future__ import annotations

from dataclasses import dataclass

from golden.datapath.formats import Formats
from hw.link.frame import KEY_BYTES
from hw.link.protocol import VERSION as PROTOCOL
from hw.map.control import MAGIC, VERSION
from hw.parameters import Parameters
from hw.sizes import SIZES, WORDS, sizes_of, words_of

CIRCUIT = {size.name: size.meaning for size in SIZES.values()} | WORDS
"""Every number that tells one circuit from another, and its meaning."""

PART = KEY_BYTES // 2
"""Bytes of the key in an item."""

IDENTITY_TEXT = {
    "magic": "`RHEO`",
    "protocol": "version of the link's protocol",
    "map_version": "version of the memory map",
    "key_low": f"first {PART} bytes of the hash of the memory map, lowest first",
    "key_high": f"the other {PART} bytes",
    **CIRCUIT,
    "clock_hz": "clock cycles a second",
    "bit_cycles": "clock cycles of a bit on the line",
}
"""The items of an identity in their order, and their meaning."""


@dataclass(frozen=True)
class Identity:
    """The identity of a circuit.

    Attributes
    ----------
    magic, protocol, map_version : int
    key : bytes
    circuit : dict
        Its sizes and word lengths, by name: those of `CIRCUIT`.
    clock_hz, bit_cycles : int
    """

    magic: int
    protocol: int
    map_version: int
    key: bytes
    circuit: dict[str, int]
    clock_hz: int
    bit_cycles: int

    @classmethod
    def of(cls, p: Parameters, key: bytes, clock_hz: int, bit_cycles: int) -> Identity:
        return cls(MAGIC, PROTOCOL, VERSION, key, sizes_of(p) | words_of(p.formats), clock_hz, bit_cycles)

    @classmethod
    def read(cls, items: list[int]) -> Identity:
        """Return the identity of its items. Raises ValueError if their number is wrong or half a key is too long."""
        if len(items) != len(IDENTITY_TEXT):
            raise ValueError(f"items must be {len(IDENTITY_TEXT)}, not {len(items)}")
        values = dict(zip(IDENTITY_TEXT, items, strict=True))
        low, high = values.pop("key_low"), values.pop("key_high")
        if (most := max(low, high)) >> 8 * PART:
            raise ValueError(f"half a key must be below 2^{8 * PART}, not {most:#x}")
        circuit = {name: values.pop(name) for name in CIRCUIT}
        return cls(key=b"".join(part.to_bytes(PART, "little") for part in (low, high)), circuit=circuit, **values)

    @property
    def items(self) -> list[int]:
        key = (int.from_bytes(part, "little") for part in (self.key[:PART], self.key[PART:]))
        values = self.magic, self.protocol, self.map_version, *key, *(self.circuit[name] for name in CIRCUIT)
        return [*values, self.clock_hz, self.bit_cycles]

    def parameters(self) -> Parameters:
        """Return the circuit's parameters, of the generic family. Raises ValueError if no circuit can have them."""
        sizes, words = ({name: self.circuit[name] for name in names} for names in (SIZES, WORDS))
        return Parameters(**sizes, formats=Formats(**words))
