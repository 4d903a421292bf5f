"""Items, the words of payloads. All have the same number of bytes, lowest byte first."""

from __future__ import annotations

from dataclasses import dataclass

from hw.link.frame import HEADER, PAYLOAD_MOST
from hw.link.protocol import GREETING_BYTES, HEAD, Kind
from hw.link.send import ANSWER_MOST

LEAST = HEAD.width // 8
"""Bytes of a segment's head, which is an item."""
assert 8 * LEAST == HEAD.width


@dataclass(frozen=True)
class Items:
    """The items of a link: their length, and what a frame holds of them.

    Raises
    ------
    ValueError
        If an item could not hold a segment's head, or the payload of a greeting could not hold an item.
    """

    bytes: int

    def __post_init__(self):
        if not LEAST <= self.bytes <= GREETING_BYTES:
            raise ValueError(f"an item must have {LEAST} to {GREETING_BYTES} bytes, not {self.bytes}")

    @classmethod
    def of_word(cls, state: int) -> Items:
        """The items that hold words of ``state`` bits."""
        return cls(max(LEAST, -(-state // 8)))

    @property
    def command_most(self) -> int:
        """Most items in a command's payload."""
        return PAYLOAD_MOST // self.bytes

    @property
    def answer_most(self) -> int:
        """Most items in an answer after the faults."""
        return (ANSWER_MOST - HEADER.size) // self.bytes - 1

    def pack(self, word: int) -> bytes:
        """Return a word as an item. Raises ValueError if it is too long."""
        if not 0 <= word < 1 << 8 * self.bytes:
            raise ValueError(f"a word must fit an item of {8 * self.bytes} bits, not be {word:#x}")
        return word.to_bytes(self.bytes, "little")

    def head(self, kind: Kind, address: int, count: int, across: bool = False) -> bytes:
        """Return a segment's head."""
        fields = {"address": address, "across": int(across), "kind": kind, "unused": 0, "count": count}
        return self.pack(HEAD.pack(fields))

    def split(self, payload: bytes) -> list[int]:
        """Return the words of a payload. Raises ValueError if its length is not that of whole items."""
        if len(payload) % self.bytes:
            raise ValueError(f"a payload must be of items of {self.bytes} bytes, not of {len(payload)} bytes")
        return [int.from_bytes(payload[n : n + self.bytes], "little") for n in range(0, len(payload), self.bytes)]
