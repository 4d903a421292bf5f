"""The emitted Verilog of the whole circuit in two simulators, through cocotb; Icarus also shows what is undefined."""

import os
import shutil
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import cocotb_core
import pytest
from cocotb_tools.runner import get_runner

from hw.emit.verilog import TOP, emit

TESTS = Path(__file__).parent
# A module that is there twice is compiled once, all at once; the little that is run needs no optimiser
ARGUMENTS = {"verilator": ["-Wno-lint", "-Wno-fatal", "-fno-inline"], "icarus": []}
UNOPTIMISED = "VM_PARALLEL_BUILDS=0 OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0"
PROGRAM = {"verilator": "verilator", "icarus": "iverilog"}


@pytest.mark.parametrize("simulator", ARGUMENTS)
def test_the_emitted_circuit(simulator, tmp_path, monkeypatch):
    if not shutil.which(PROGRAM[simulator]):
        pytest.skip(f"{PROGRAM[simulator]} is not installed (Debian: apt install {PROGRAM[simulator]})")
    source = tmp_path / f"{TOP}.v"
    source.write_text(emit(cocotb_core.PARAMETERS)[0])
    monkeypatch.setenv("MAKEFLAGS", f"{os.environ['MAKEFLAGS']} {UNOPTIMISED}")
    runner = get_runner(simulator)
    runner.build(
        sources=[source],
        hdl_toplevel=TOP,
        build_dir=tmp_path,
        build_args=ARGUMENTS[simulator],
        always=True,
        timescale=("1ns", "1ps"),
        log_file=tmp_path / "build.log",
    )
    results = runner.test(
        hdl_toplevel=TOP,
        test_module="cocotb_core",
        build_dir=tmp_path,
        test_dir=tmp_path,
        results_xml=str(tmp_path / "results.xml"),
        extra_env={"PYTHONPATH": f"{TESTS}:{TESTS.parent}"},
    )
    cases = ElementTree.parse(results).getroot().iter("testcase")
    names = [case.get("name") for case in cases]
    assert len(names) == 11
