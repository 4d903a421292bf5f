"""The Verilog and its manifest: the same bytes anywhere, clean to a linter, one multiplier for each product."""

import json
import os
import re
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pytest

from hw import build, lint
from hw.parameters import Parameters
from hw.verilog import LANE, TOP

ROOT = Path(__file__).resolve().parent.parent
SMALL = {"lanes": 1, "nodes": 16, "edges": 1, "materials": 1, "tables": 1}
OPTIONS = [word for name, value in SMALL.items() for word in (f"--{name}", str(value))]


@pytest.fixture(scope="module")
def emitted(tmp_path_factory):
    """Two folders with the same circuit, written from two working directories with two hash seeds."""
    folders = []
    for seed in ("1", "4711"):
        work = tmp_path_factory.mktemp(f"seed{seed}")
        environment = os.environ | {"PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-m", "hw", "verilog", *OPTIONS, "--out", "out"]
        subprocess.run(command, cwd=work, env=environment, check=True, capture_output=True)
        folders.append(work / "out")
    return folders


def test_same_bytes(emitted):
    for name in (build.VERILOG, build.MANIFEST):
        first, second = (folder.joinpath(name).read_bytes() for folder in emitted)
        assert first == second
        assert str(ROOT).encode() not in first


def test_nothing_is_left_beside_the_two_files(emitted):
    assert sorted(path.name for path in emitted[0].iterdir()) == [build.MANIFEST, build.VERILOG]


def test_manifest_describes_the_verilog(emitted):
    text = emitted[0].joinpath(build.VERILOG).read_text()
    manifest = json.loads(emitted[0].joinpath(build.MANIFEST).read_text())
    assert manifest["files"][build.VERILOG]["sha256"] == sha256(text.encode()).hexdigest()
    assert {name: manifest["parameters"][name] for name in SMALL} == SMALL
    header = re.search(rf"^module {TOP}\((.*?)\);", text, re.MULTILINE | re.DOTALL)[1]
    assert {port["name"] for port in manifest["ports"]} == set(re.findall(r"\w+", header))
    for port in manifest["ports"]:
        width = rf"\[{port['bits'] - 1}:0\] " if port["bits"] > 1 else ""
        assert re.search(rf"^  {port['direction']}put {width}{port['name']};", text, re.MULTILINE), port


def test_verilator_has_nothing_to_say(emitted):
    assert lint.lint(emitted[0] / build.VERILOG, top=TOP) == []


def test_without_the_waivers_it_has(emitted):
    assert lint.lint(emitted[0] / build.VERILOG, top=TOP, waivers=None)


def test_a_lane_has_23_multipliers_of_18_bits(emitted):
    text = emitted[0].joinpath(build.VERILOG).read_text()
    places = re.findall(rf"^  {LANE}_multiplier_[us](\d+)_[us](\d+) \w+ \(", text, re.MULTILINE)
    assert len(places) == 23
    assert all(int(a) <= 18 and int(b) <= 18 for a, b in places)
    # and no product is hidden elsewhere
    modules = re.split(r"^module ", text, flags=re.MULTILINE)
    assert {m.split("(")[0] for m in modules if " * " in m and "_multiplier_" not in m.split("(")[0]} == set()


def test_only_legal_plain_names(emitted):
    assert "\\" not in emitted[0].joinpath(build.VERILOG).read_text()


def test_up_to_date_files_stay(emitted):
    folder, parameters = emitted[0], Parameters(**SMALL)
    assert not build.build(parameters, folder)
    damaged = folder / build.VERILOG
    whole = damaged.read_text()
    damaged.write_text(whole[:-100])
    assert build.build(parameters, folder)
    assert damaged.read_text() == whole
