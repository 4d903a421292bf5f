"""A lane's memories of its edges' states."""

from golden.datapath import records
from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.machine.memory_ports import Use, registered_ports
from hw.machine.routes import HANDOVER, PORT

NEXT = {"base": "base_next", "ratio": "ratio_next", "total": "total_next"}
"""The edge processor's outputs, by the word of an edge that each is written to."""

REGISTERS = 1
"""Registers from a memory to the edge processor: block RAMs sit at fixed sites."""


def edge_memories(m, lines, p, datapath, issued, outputs, host) -> dict:
    """Write the memories into a lane's module. Return the edge processor's inputs that are edges' words.

    A word is read when the edge processor needs it and written when it is done.
    """

    def by_host(value, name):
        return lines.later(value, HANDOVER - PORT, name=name, reset=True)

    active = by_host(host.active, "host_active")
    index, data = by_host(host.index, "host_index"), by_host(host.data, "host_data")
    length, ratio = by_host(host.write.length, "host_write_length"), by_host(host.write.ratio, "host_write_ratio")
    strobes = {"length": length, "base": ratio, "ratio": ratio}
    inputs, rams = {}, {}
    for word, q in records.edge_state(p.formats).items():
        m.submodules[f"edge_{word}"] = rams[word] = ram = BlockRam(width=q.width, depth=p.rows)
        name = f"edge_{word}"
        inputs[name] = lines.later(ram.data, REGISTERS, name=f"near_{word}")
        address = issued.at("row", datapath.schedule.arrival[name] - READ_LATENCY - REGISTERS - PORT)
        own = Use(address=address)
        if word in NEXT:
            ready = datapath.ready(NEXT[word])
            valid, row = issued.at("valid", ready), issued.at("row", ready)
            own = Use(address=address, write=valid, write_address=row, write_data=outputs[NEXT[word]])
        theirs = Use()
        if word in strobes:
            read = index if word in ("length", "ratio") else None
            theirs = Use(address=read, write=strobes[word], write_address=index, write_data=data)
        registered_ports(m, ram, name, active, theirs, own)
    m.d.comb += [host.words.length.eq(rams["length"].data), host.words.ratio.eq(rams["ratio"].data)]
    return inputs
