"""Gowin Arora V: its devices, and where everything else is. The open tools know no PLL of it, and time no multiplier
and no block RAM."""

from pathlib import Path

from hw.families.family import Family
from hw.families.gowin.blocks import GowinBlocks
from hw.families.gowin.flow import GowinFlow
from hw.families.resources import Capacity

# From Project Apicula's database. A MULT27X36 is two of the device's 298 multipliers of 27x18 bits
DEVICES = {
    "GW5AST-LV138FPG676AC1/I0": Capacity(luts=138240, ffs=138240, multipliers=149, block_rams=340),
}

FAMILY = Family(Path(__file__).parent, blocks=GowinBlocks(), devices=DEVICES, flow=GowinFlow())
