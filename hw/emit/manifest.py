"""The manifest beside the Verilog: everything that a driver or a reader has to know about the circuit."""

import hashlib

from amaranth.hdl import Shape
from amaranth.lib.wiring import In

from hw.emit.latencies import latencies
from hw.link.description import description, dump
from hw.machine.core import Core
from hw.parameters import Parameters
from hw.sizes import sizes_of, words_of

DESIGN = "rheogate"

PORTS = {
    "clk": "the one clock, rising edge",
    "rst": "synchronous; memories keep their contents",
    "request": "1 in each cycle in which address, write and write_data are a request",
    "write": "1: write write_data; 0: read the word",
    "address": "see address",
    "write_data": "a word, lowest bits first",
    "answer": "1 in the cycle of a request's answer; answers come in order",
    "error": "with an answer: the request was refused and nothing was changed",
    "read_data": "with an answer: the word that was read, 0 if refused",
    "busy": "1 while a run is under way",
}


def manifest(core: Core, verilog: str, key: str) -> dict:
    """Return the manifest of the circuit with this Verilog text; ``key`` is that of its sources."""
    p = core.parameters
    contents = {
        "design": DESIGN,
        "key": key,
        "parameters": parameters(p),
        "files": {"rheogate.v": {"sha256": digest(verilog), "bytes": len(verilog.encode())}},
        "ports": _ports(core),
        **description(p),
        "latencies": [{"of": of, "from_to": what, "cycles": cycles} for of, what, cycles in latencies(p)],
        "pipelines": {
            "edge": _pipeline(core.datapath.schedule),
            "node": _pipeline(core.node_datapath.schedule),
        },
    }
    return contents | {"sha256": own_digest(contents)}


def parameters(p: Parameters) -> dict:
    """Return sizes, word lengths and family by name."""
    return {**sizes_of(p), "rows": p.rows, **words_of(p.formats), "family": p.family}


def digest(text: str) -> str:
    """Return the SHA-256 of a text, in hexadecimal."""
    return hashlib.sha256(text.encode()).hexdigest()


def own_digest(contents: dict) -> str:
    """Return the hash of a manifest without its own hash."""
    return digest(dump({name: value for name, value in contents.items() if name != "sha256"}))


def _ports(core):
    members = core.signature.members.items()
    ports = {"clk": ("in", 1), "rst": ("in", 1)}
    ports |= {name: ("in" if member.flow == In else "out", Shape.cast(member.shape).width) for name, member in members}
    return [
        {"name": name, "direction": direction, "bits": bits, "meaning": PORTS[name]}
        for name, (direction, bits) in ports.items()
    ]


def _pipeline(schedule):
    return {
        "cycles": schedule.latency,
        "arrival": schedule.arrival,
        "operations": [
            {"name": name, "operation": kind, "from": start, "to": end} for name, kind, start, end in schedule.stages()
        ],
    }
