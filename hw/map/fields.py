"""The bits that tell a datapath its stage, as hardware values."""

from amaranth.hdl import Array

from golden.datapath.rk4 import RK4


def stage_bits(stage) -> dict:
    """The bits that tell a datapath its stage, by the names of its ports, for a stage number."""
    return {f"stage_{bit}": Array([RK4.stage(s)[bit] for s in range(RK4.stages)])[stage] for bit in RK4.stage(0)}
