"""Lattice ECP5: its devices, the limits of its hard blocks, and where everything else is."""

from pathlib import Path

from hw.families.ecp5.blocks import Ecp5Blocks
from hw.families.ecp5.flow import Ecp5Flow
from hw.families.ecp5.pll import PLL
from hw.families.family import Family, Limits
from hw.families.resources import Capacity

# By the name of nextpnr's option. LFE5U-12F and -25F are the same die, all of which the open tools use; for the
# first, the data sheet promises half of the lookup tables and 32 block RAMs.
DEVICES = {
    "12k": Capacity(luts=24288, ffs=24288, multipliers=28, block_rams=56),
    "25k": Capacity(luts=24288, ffs=24288, multipliers=28, block_rams=56),
    "45k": Capacity(luts=43848, ffs=43848, multipliers=72, block_rams=108),
    "85k": Capacity(luts=83640, ffs=83640, multipliers=156, block_rams=208),
}

# The data sheet, FPGA-DS-02012, "Register-to-Register Performance", has grade 8 alone: 225 MHz for an 18x18 multiplier
# and 272 MHz for a block RAM; both are from memory, as the data sheet was not at hand. Grade 6 follows from Project
# Trellis's database of the vendor's timing, ECP5/timing/speed_*/cells.json:
# block RAM: its shortest clock pulse is 2.359 ns (grade 8: 1.842 ns, which is 271 MHz, as the data sheet says). This
#   holds without WRITEMODE = READBEFOREWRITE, which takes 3.235 ns: 154 MHz.
# multiplier: an estimate. 225 MHz, slower by the ratio of its longest stage in the two grades, 2.625 ns to 1.985 ns.
#   A multiplier whose last register is outside (hw/blocks/multiplier.py) has none in the middle: 3.864 ns from its
#   input to its output, 258 MHz.
LIMITS_MHZ = {6: Limits(multiplier=170.0, block_ram=212.0)}

FAMILY = Family(
    Path(__file__).parent,
    blocks=Ecp5Blocks(),
    devices=DEVICES,
    pll=PLL,
    flow=Ecp5Flow(),
    limits_mhz=LIMITS_MHZ,
)
