"""Xilinx 7 series: its devices, and where everything else is. It has no blocks of its own: Yosys and Vivado find the
multipliers and block RAMs of the generic circuit. Nothing is timed here, as Vivado is not free."""

from pathlib import Path

from hw.families.family import Family
from hw.families.resources import Capacity
from hw.families.xilinx.flow import XilinxFlow
from hw.families.xilinx.pll import PLL

DEVICES = {
    # Block RAMs are halves of 18 kbit
    "xc7a100tcsg324-1": Capacity(luts=63400, ffs=126800, multipliers=240, block_rams=270),
}

FAMILY = Family(Path(__file__).parent, devices=DEVICES, pll=PLL, flow=XilinxFlow())
