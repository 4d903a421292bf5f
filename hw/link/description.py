"""The description of a circuit for its drivers, for the manifest, the C header, the page and the link's key."""

import hashlib
import json

from golden.numbers.qformat import Q
from golden.numbers.record import Record
from hw.link import protocol
from hw.link.frame import KEY_BYTES
from hw.link.identity import IDENTITY_TEXT
from hw.link.items import Items
from hw.link.registers import LINK, LINK_TEXT, Link
from hw.machine.core import datapaths, faults
from hw.map.control import REGISTERS, VERSION
from hw.map.memory_map import ADDRESS, Map, Region
from hw.parameters import Parameters


def description(p: Parameters) -> dict:
    """Return the memory map, registers, faults, formats and the protocol of the link, as plain types for JSON."""
    memory = Map(p)
    return {
        "map_version": VERSION,
        "address": _address(),
        "regions": [_region(memory, region) for region in Region],
        "registers": [_register(r, not row.writable, row.meaning) for r, row in REGISTERS.items()],
        "faults": [{"bit": bit, "name": name} for bit, name in enumerate(faults(*datapaths(p)))],
        "formats": [{"name": q.name, **_format(q), "unit": q.unit} for q in p.formats.all()],
        "link": {
            "version": protocol.VERSION,
            "item_bytes": Items.of_word(p.formats.state).bytes,
            "greeting_bytes": protocol.GREETING_BYTES,
            "region": LINK,
            "registers": [_register(r, False, LINK_TEXT[r]) for r in Link],
            "operations": _numbered(protocol.OPERATION_TEXT),
            "kinds": _numbered(protocol.KIND_TEXT),
            "statuses": _numbered(protocol.STATUS_TEXT),
            "busy": protocol.BUSY,
            "head": _fields(protocol.HEAD),
            "identity": _listed(IDENTITY_TEXT),
        },
    }


def key(p: Parameters) -> bytes:
    """Return the bytes that go before a frame in its CRC; a circuit with another description has another key."""
    return hashlib.sha256(dump(description(p)).encode()).digest()[:KEY_BYTES]


def dump(contents: dict) -> str:
    """Return contents as JSON."""
    return json.dumps(contents, indent=1) + "\n"


def _listed(texts):
    return [{"item": number, "name": name, "meaning": text} for number, (name, text) in enumerate(texts.items())]


def _register(register, read_only, meaning):
    return {
        "index": register.value,
        "name": register.name,
        "read_only": read_only,
        "meaning": meaning,
    }


def _numbered(texts):
    return [{"number": member.value, "name": member.name, "meaning": text} for member, text in texts.items()]


def _address():
    return [{"name": name, "low": ADDRESS.offsets[name], "bits": q.width} for name, q in ADDRESS.items()]


def _region(memory: Map, region: Region):
    return {
        "number": region.value,
        "name": region.name,
        "depth": memory.depth(region),
        "lanes": memory.lanes(region),
        "words": [
            {
                "number": number,
                "name": word,
                "read_only": memory.read_only(region, word),
                "fields": _fields(memory.fields(region, word)),
            }
            for number, word in enumerate(memory.words(region))
        ],
    }


def _fields(record: Record):
    return [{"name": name, "low": record.offsets[name], **_format(q)} for name, q in record.items()]


def _format(q: Q):
    return {"bits": q.width, "signed": q.signed, "fraction_bits": q.frac_bits}
