"""What goes with the Verilog: everything that a driver, or a reader, has to know about this very circuit."""

import hashlib
import json

from amaranth.hdl import Shape
from amaranth.lib.wiring import In

from golden.qformat import Q

from .core import Core
from .latency import latencies
from .parameters import Parameters
from .registers import (
    CONTROL_TEXT,
    INDEX_BITS,
    LANE_BITS,
    READ_ONLY,
    REGION_BITS,
    VERSION,
    WORD_BITS,
    Control,
    Map,
    Region,
)

DESIGN = "rheogate"

PORTS = {
    "clk": "the one clock, rising edge",
    "rst": "synchronous; memories keep their contents",
    "request": "1 for every cycle in which address, write and write_data are a request",
    "write": "1: write_data is to be written; 0: the word is to be read",
    "address": "see address",
    "write_data": "a word, lowest bits first",
    "answer": "1 in the cycle of a request's answer; answers come in order",
    "error": "with an answer: the request was refused and nothing was changed",
    "read_data": "with an answer: what was read, 0 if refused",
    "busy": "1 while steps are run",
}


def manifest(core: Core, verilog: str, key: str) -> dict:
    """The manifest of the circuit whose text is ``verilog``; ``key`` tells what it was made from."""
    p, fmt, memory = core.parameters, core.parameters.formats, Map(core.parameters)
    contents = {
        "design": DESIGN,
        "key": key,
        "map_version": VERSION,
        "parameters": parameters(p),
        "files": {"rheogate.v": {"sha256": digest(verilog), "bytes": len(verilog.encode())}},
        "ports": _ports(core),
        "address": _address(),
        "regions": [_region(memory, region) for region in Region],
        "registers": [
            {"index": r.value, "name": r.name, "read_only": r in READ_ONLY, "meaning": CONTROL_TEXT[r]}
            for r in Control
        ],
        "faults": [{"bit": bit, "name": name} for bit, name in enumerate(core.faults)],
        "formats": [{"name": q.name, **_format(q), "unit": q.unit} for q in fmt.all()],
        "latencies": [{"of": of, "from_to": what, "cycles": cycles} for of, what, cycles in latencies(core.parameters)],
        "pipelines": {
            "edge": _pipeline(core.datapath.schedule),
            "node": _pipeline(core.node_datapath.schedule),
        },
    }
    return contents | {"sha256": own_digest(contents)}


def parameters(p: Parameters) -> dict:
    return {
        "lanes": p.lanes,
        "updates": p.updates,
        "nodes": p.nodes,
        "edges": p.edges,
        "rows": p.rows,
        "materials": p.materials,
        "tables": p.tables,
        "operand": p.formats.operand,
        "state": p.formats.state,
        "family": p.family,
    }


def digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def own_digest(contents: dict) -> str:
    """Of the manifest without its own hash, as `dump` writes it."""
    return digest(dump({name: value for name, value in contents.items() if name != "sha256"}))


def dump(contents: dict) -> str:
    return json.dumps(contents, indent=1) + "\n"


def _ports(core):
    members = core.signature.members.items()
    ports = {"clk": ("in", 1), "rst": ("in", 1)}
    ports |= {name: ("in" if member.flow == In else "out", Shape.cast(member.shape).width) for name, member in members}
    return [
        {"name": name, "direction": direction, "bits": bits, "meaning": PORTS[name]}
        for name, (direction, bits) in ports.items()
    ]


def _address():
    fields, low = [], 0
    for name, bits in (("index", INDEX_BITS), ("word", WORD_BITS), ("lane", LANE_BITS), ("region", REGION_BITS)):
        fields.append({"name": name, "low": low, "bits": bits})
        low += bits
    return fields


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


def _fields(record: dict[str, Q]):
    fields, low = [], 0
    for name, q in record.items():
        fields.append({"name": name, "low": low, **_format(q)})
        low += q.width
    return fields


def _format(q: Q):
    return {"bits": q.width, "signed": q.signed, "fraction_bits": q.frac_bits}


def _pipeline(schedule):
    return {
        "cycles": schedule.latency,
        "arrival": schedule.arrival,
        "operations": [
            {"name": name, "operation": kind, "from": start, "to": end} for name, kind, start, end in schedule.stages()
        ],
    }
