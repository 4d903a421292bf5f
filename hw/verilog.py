"""The Verilog of the circuit: each kind of module once, the same bytes for the same parameters."""

import os
from functools import cache

from amaranth.back import verilog
from amaranth.hdl import ClockSignal, Instance, Module, ResetSignal
from amaranth.lib import wiring
from amaranth.lib.wiring import In

from .core import Core
from .edge import EdgeDatapath
from .lane import Lane, members
from .parameters import Parameters

TOP = "rheogate"
LANE = "rheogate_lane"


class PlacedLane(wiring.Component):
    """A lane as an instance of the Verilog module that is made from it elsewhere."""

    def __init__(self, parameters: Parameters, datapath: EdgeDatapath):
        super().__init__(members(parameters, datapath))

    def elaborate(self, platform):
        m = Module()
        ports = {"i_clk": ClockSignal(), "i_rst": ResetSignal()}
        for name, member in self.signature.members.items():
            ports[f"{'i' if member.flow == In else 'o'}_{name}"] = getattr(self, name)
        m.submodules.lane = Instance(LANE, **ports)
        return m


@cache
def modules(parameters: Parameters) -> tuple[str, str, Core]:
    """(Verilog of `LANE`, Verilog of `TOP`, the circuit they were made from), with what each is made of."""
    os.environ["AMARANTH_USE_YOSYS"] = "builtin"  # another Yosys would write other bytes
    core = Core(parameters, PlacedLane)
    options = {"emit_src": False, "strip_internal_attrs": True}
    lane = verilog.convert(Lane(parameters, core.datapath), name=LANE, **options)
    return lane, verilog.convert(core, name=TOP, **options), core


def emit(parameters: Parameters) -> tuple[str, Core]:
    """(the Verilog text, the circuit it was made from).

    The text has the module `TOP`, with one `LANE` for each lane, and what they are made of.
    """
    lane, top, core = modules(parameters)
    return lane + "\n" + top, core
