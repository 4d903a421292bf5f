"""python -m hw timing: what it makes of the tools' reports, what it writes and refuses; the tools stand aside."""

import json
import sys

import msgspec
import pytest

from golden.support.errors import InputError
from hw.__main__ import main
from hw.boards import board as boards
from hw.boards.timing import command, flow, report, result, tools
from hw.boards.timing.frame import FRAME
from hw.boards.timing.report import Step
from hw.boards.timing.result import Result
from hw.families.cells import Sizes
from hw.sizes import SIZES as CIRCUIT_SIZES

STATISTICS = {
    "modules": {"\\rheogate": {}, f"\\{FRAME}": {"num_cells_by_type": {"LUT4": 39, "TRELLIS_FF": 106, "rheogate": 1}}},
    "design": {
        "num_cells_by_type": {
            "LUT4": 1039,
            "CCU2C": 300,
            "TRELLIS_DPR16X4": 5,
            "TRELLIS_FF": 2106,
            "PFUMX": 70,
            "MULT18X18D": 23,
            "DP16KD": 10,
            "PDPW16KD": 3,
        }
    },
}
USED = {"TRELLIS_COMB": 1739, "TRELLIS_FF": 2106, "TRELLIS_RAMW": 5, "MULT18X18D": 23, "DP16KD": 13, "DCCA": 1}
CLOCK = "posedge $glbnet$clk$TRELLIS_IO_IN"
PATH = [
    ("clk-to-q", 0.52, "core.lane0.ram.words.0.0"),
    ("routing", 1.0, "core.queue.words.0.0$DPRAM_COMB2"),
    ("logic", 0.24, "core.queue.words.0.0$DPRAM_COMB2"),
    ("routing", 0.5, "core.queue.words.0.1_DO_1_CCU2C_B1$CCU2_COMB0"),
    ("logic", 0.44, "$nextpnr_CCU2C_241$CCU2_COMB0"),
    ("routing", 2.3, "core.sequencer.left_TRELLIS_FF_Q_21"),
    ("setup", 0.0, "core.sequencer.left_TRELLIS_FF_Q_21"),
]
STEPS = [Step("lane0.ram.words", 0.52), Step("queue.words", 2.18), Step("sequencer.left", 2.3)]
SIZES = Sizes(lut=1700, ff=2000, multipliers=23, block_rams=13, lut_ram=20)


def reported(mhz: float, path=PATH) -> dict:
    """What nextpnr would report, with a longer path from a pin."""
    parts = [{"type": kind, "delay": delay, "to": {"cell": cell}} for kind, delay, cell in path]
    return {
        "fmax": {CLOCK.removeprefix("posedge "): {"achieved": mhz, "constraint": 150}},
        "utilization": {name: {"used": used, "available": 10**6} for name, used in USED.items()},
        "critical_paths": [
            {"from": "<async>", "to": CLOCK, "path": [parts[0] | {"delay": 99.0}]},
            {"from": CLOCK, "to": CLOCK, "path": parts},
        ],
    }


@pytest.fixture
def tools_aside(monkeypatch, tmp_path):
    """No tool runs, and nothing is written to the checkout; the clock that each seed gives, to be changed."""
    clocks = {1: 120.004, 2: 133.0, 3: 101.5, 7: 250.0}
    monkeypatch.setattr(flow, "framed", lambda parameters: f"// {parameters.lanes} lanes\n")
    monkeypatch.setattr(tools, "synthesise", lambda verilog, folder, name, board=None: STATISTICS)
    monkeypatch.setattr(tools, "place_and_route", lambda board, folder, name, seed: reported(clocks[seed]))
    monkeypatch.setattr(command, "ROOT", tmp_path)
    monkeypatch.setattr(command, "OUT", tmp_path / "build")
    monkeypatch.setattr(command, "KEPT", tmp_path / "kept")
    return clocks


def measured(**chosen) -> Result:
    board = boards.load("ulx3s-85f")
    return flow.measure("ulx3s-85f", board, board.parameters(**chosen), [1, 2, 3], None, lambda doing: None)


def test_sizes_leave_the_frame_out():
    assert report.sizes(STATISTICS) == (
        Sizes(lut=1620, ff=2000, multipliers=23, block_rams=13, lut_ram=20),
        Sizes(lut=39, ff=106, multipliers=0, block_rams=0, lut_ram=0),
    )
    assert report.placed(reported(100)) - report.sizes(STATISTICS)[1] == SIZES


def test_the_critical_path_is_from_register_to_register():
    assert report.critical_path(reported(100)) == STEPS


@pytest.mark.parametrize(
    "cell, name",
    [
        ("core.lane0.edge.multiplier_3.product_1_TRELLIS_FF_Q_12", "lane0.edge.multiplier_3.product_1"),
        ("core.sequencer.nodes_over_LUT4_B_Z_LUT4_Z", "sequencer.nodes_over"),
        ("core.sequencer.summed_TRELLIS_FF_Q_11_DI_LUT4_Z_C_CCU2C_S1_S0_CCU2C_S0", "sequencer.summed"),
        ("core.lane0.ram.words.0.0_DOB10", "lane0.ram.words"),
        ("core.lane0.ram.words.0.0", "lane0.ram.words"),
        ("core.m3.product_MULT18X18D_P0", "m3.product"),
        ("core.lane0.t12_next", "lane0.t12_next"),
        ("gathered_TRELLIS_FF_Q_3", "gathered"),
        ("$nextpnr_CCU2C_241$CCU2_COMB0", ""),
    ],
)
def test_names_are_the_designs_own(cell, name):
    assert report.own_name(cell) == name


def test_a_result(tools_aside):
    found = measured(lanes=2)
    assert (found.board, found.lanes, found.nodes, found.grade, found.seeds) == ("ulx3s-85f", 2, 512, 6, [1, 2, 3])
    assert found.fmax_mhz == [120.0, 133.0, 101.5]
    assert (found.fmax_min, found.fmax_median, found.clock_mhz) == (101.5, 120.0, 120.0)
    assert (found.lut, found.ff, found.multipliers, found.block_rams, found.lut_ram) == (1700, 2000, 23, 13, 20)
    assert found.critical_path == STEPS
    assert found.tools == tools.versions() and len(found.sha256) == 64


def test_the_path_is_that_of_the_median(tools_aside, monkeypatch):
    def placed(board, folder, name, seed):
        return reported(tools_aside[seed], [("logic", 1.0, f"core.seed_{seed}")])

    monkeypatch.setattr(tools, "place_and_route", placed)
    assert measured().critical_path == [Step("seed_1", 1.0)]


def test_the_lowest_limit_is_the_clock(tools_aside):
    tools_aside.update({1: 250, 2: 260, 3: 270})
    assert measured().clock_mhz == boards.load("ulx3s-85f").limits_mhz.multiplier


def test_a_circuit_that_does_not_fit(tools_aside):
    board = boards.load("ulx3s-25f")
    board.holds.multipliers, board.holds.block_rams = 22, 5
    with pytest.raises(InputError) as caught:
        flow.measure("ulx3s-25f", board, board.parameters(), [1], None, lambda doing: None)
    assert str(caught.value) == (
        "the circuit must fit ulx3s-25f, not take 23 multipliers of 22, 13 block RAMs of 5: "
        "choose fewer lanes, nodes or edges"
    )


def test_the_table(tools_aside):
    lines = result.table(measured(), boards.load("ulx3s-85f")).splitlines()
    assert lines[0] == (
        "ulx3s-85f (85k, speed grade 6): 4 lanes, 1 update, 512 nodes, 4096 edges, 16 materials, 4 tables"
    )
    assert lines[2] == "Fmax    101.5 MHz at least, 120.0 MHz median of 120.0, 133.0, 101.5"
    assert lines[6:9] == [
        "              takes      of",
        "LUT            1700   83640    2%",
        "FF             2000   83640    2%",
    ]
    assert lines[-4:] == [
        "critical path, 5.00 ns, of the run with the median",
        "    0.52  lane0.ram.words",
        "    2.18  queue.words",
        "    2.30  sequencer.left",
    ]
    assert max(map(len, lines)) <= 100


def test_what_is_kept_is_published(tools_aside, tmp_path):
    result.write(tmp_path / "ulx3s-85f.json", measured())
    header, rule, small, large = result.published(tmp_path).splitlines()
    assert header.count("|") == rule.count("|") == small.count("|") == large.count("|")
    assert small.startswith("| ulx3s-25f | not timed yet |")
    assert large == (
        "| ulx3s-85f | 4 | 1 | 512 | 4096 | 1700 (2%) | 2000 (2%) | 23 (15%) | 13 (6%) | 101.5 MHz | "
        "120.0 MHz | 170.0 MHz | 120.0 MHz |"
    )


def test_files_that_are_kept_are_results():
    for path in result.KEPT.glob("*.json"):
        found = result.read(path, Result if path.stem in boards.names() else result.Smallest)
        if isinstance(found, Result):
            assert found.board == path.stem and len(found.seeds) >= 3


def said(capsys):
    captured = capsys.readouterr()
    return captured.out.splitlines(), captured.err.splitlines()


def test_the_command_writes_figures(tools_aside, tmp_path, capsys):
    assert main(["timing", "--board", "ulx3s-85f", "--lanes", "2", "--seeds", "7", "1"]) == 0
    out, err = said(capsys)
    assert "2 lanes" in out[0] and err == ["figures: build/ulx3s-85f.json"]
    found = json.loads((tmp_path / "build" / "ulx3s-85f.json").read_text())
    assert (found["lanes"], found["seeds"], found["fmax_median"]) == (2, [7, 1], 185.0)
    assert msgspec.convert(found, Result) == result.read(tmp_path / "build" / "ulx3s-85f.json", Result)
    assert not (tmp_path / "kept").exists()


def test_keep_publishes(tools_aside, tmp_path, capsys):
    assert main(["timing", "--board", "ulx3s-85f", "--keep"]) == 0
    assert main(["timing", "--smallest", "--keep"]) == 0
    assert said(capsys)[1][1] == "figures: kept/ulx3s-85f.json"
    assert {path.name for path in (tmp_path / "kept").iterdir()} == {"ulx3s-85f.json", "smallest.json"}


HELP = "(see python -m hw timing --help)"


@pytest.mark.parametrize(
    "options, message",
    [
        ("", f"one of the arguments --board --smallest is required {HELP}"),
        ("--board x", "--board must be arty-a7-100 or tang-mega-138k-pro or ulx3s-25f or ulx3s-85f, not 'x'"),
        (
            "--board arty-a7-100",
            "--board must be one whose device the tools time, ulx3s-25f or ulx3s-85f, not 'arty-a7-100'",
        ),
        ("--board ulx3s-85f --lanes 0", "--lanes must be a whole number from 1 to {lanes}, not 0"),
        ("--board ulx3s-85f --seeds 1 0", "--seeds must be different numbers from 1 to 2147483647, not 0"),
        ("--board ulx3s-85f --seeds 1 2 1", "--seeds must be different numbers from 1 to 2147483647, not 1"),
        ("--board ulx3s-85f --seeds a", f"argument --seeds: must be a whole number, not 'a' {HELP}"),
        ("--board ulx3s-85f --keep --seeds 1 2", "--keep must be of the board's own circuit and at least 3 seeds"),
        ("--board ulx3s-85f --jobs 0", "--jobs must be 1 to 64, not 0"),
        ("--board ulx3s-85f --keep --lanes 1", "--keep must be of the board's own circuit and at least 3 seeds"),
    ],
)
def test_impossible_options_are_one_line(options, message, tools_aside, tmp_path, capsys):
    assert main(["timing", *options.split()]) == 2
    message = message.format(lanes=CIRCUIT_SIZES["lanes"].allowed[-1])
    assert said(capsys) == ([], [f"error: {message}"])


def test_progress_only_where_somebody_watches(tools_aside, capsys, monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    with command.progress(2) as shown:
        shown("synthesis")
        shown("seed 1")
    assert "seed 1" in capsys.readouterr().err
    monkeypatch.setattr(sys.stderr, "isatty", lambda: False, raising=False)
    with command.progress(2) as shown:
        shown("synthesis")
    assert capsys.readouterr().err == ""
