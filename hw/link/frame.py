"""Frames on the line: ``00 | COBS(header, payload, CRC-32) | 00``.

The header is type, seq, status, bytes of an item (0 in commands) and the payload's length, two bytes, lowest first. The
CRC, that of Ethernet and zlib, is over the key, header and payload; the key is not sent. So circuit and host drop each
other's frames if their memory maps differ. A greeting and its answer have no key: they tell a host about the circuit.
"""

import struct
import zlib
from dataclasses import dataclass

from amaranth.lib import crc
from cobs import cobs

HEADER = struct.Struct("<BBBBH")
PAYLOAD_MOST = 512
CRC_BYTES = 4
KEY_BYTES = 8
LEAST, MOST = HEADER.size + CRC_BYTES, HEADER.size + PAYLOAD_MOST + CRC_BYTES
"""Bytes of a frame before COBS, without its zeros."""

CRC = crc.catalog.CRC32_ISO_HDLC
GREETING = 0x01
"""The type of a greeting."""
ANSWER = 0x80
"""Bit that is set in the type of every answer."""


class FrameError(ValueError):
    """Bytes aren't a frame; ``kind`` names the counter of the circuit for such errors."""

    def __init__(self, kind: str):
        super().__init__(kind)
        self.kind = kind


@dataclass(frozen=True)
class Frame:
    type: int
    seq: int
    status: int = 0
    payload: bytes = b""
    item_bytes: int = 0

    def packed(self, key: bytes) -> bytes:
        """Return the bytes on the line. Raises ValueError if the payload is too long."""
        if len(self.payload) > PAYLOAD_MOST:
            raise ValueError(f"payload must be at most {PAYLOAD_MOST} bytes, not {len(self.payload)}")
        body = HEADER.pack(self.type, self.seq, self.status, self.item_bytes, len(self.payload)) + self.payload
        return b"\0" + cobs.encode(body + struct.pack("<I", _crc(body, key))) + b"\0"


def unpacked(coded: bytes, key: bytes) -> Frame:
    """Return the frame in the bytes between two zeros. Raises `FrameError`."""
    try:
        body = cobs.decode(coded)
    except cobs.DecodeError:
        raise FrameError("cobs_errors") from None
    if len(body) < LEAST or len(body) > MOST:
        raise FrameError("length_errors")
    type_, seq, status, item_bytes, length = HEADER.unpack_from(body)
    if len(body) != LEAST + length:
        raise FrameError("length_errors")
    if struct.pack("<I", _crc(body[:-CRC_BYTES], key)) != body[-CRC_BYTES:]:
        raise FrameError("crc_errors")
    return Frame(type_, seq, status, body[HEADER.size : -CRC_BYTES], item_bytes)


def _crc(body: bytes, key: bytes) -> int:
    return zlib.crc32(body, zlib.crc32(key) if body[0] & ~ANSWER != GREETING else 0)
