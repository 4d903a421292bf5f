"""Fields of packed records, and the bits that tell a datapath its stage, as hardware values."""

from amaranth.hdl import Array

from golden.datapath.rk4 import RK4


def unpack(record, word):
    """The fields of a packed record (`golden.datapath.records.pack`) as slices."""
    fields, low = {}, 0
    for name, q in record.items():
        fields[name] = word[low : low + q.width]
        low += q.width
    return fields


def stage_bits(stage) -> dict:
    """The bits that tell a datapath its stage, by the names of its ports, for a stage number."""
    return {f"stage_{bit}": Array([RK4.stage(s)[bit] for s in range(RK4.stages)])[stage] for bit in RK4.stage(0)}
