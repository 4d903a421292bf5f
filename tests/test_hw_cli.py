"""python -m hw: options, progress and exit codes that all commands share."""

import subprocess
import sys
from pathlib import Path

import pytest
from cli_objects import output, record_circuits, refused, write_verilog

from hw.emit import build

ROOT = Path(__file__).resolve().parents[1]
HELP = "(see python -m hw verilog --help)"
IMPOSSIBLE = {
    "--lanes 0": "--lanes must be a whole number from 1 to 8, not 0",
    "--lanes 9": "--lanes must be a whole number from 1 to 8, not 9",
    "--nodes 1": "--nodes must be a whole number from 2 to 4096, not 1",
    "--nodes 4097": "--nodes must be a whole number from 2 to 4096, not 4097",
    "--edges -3": "--edges must be a whole number from 1 to 65536, not -3",
    "--edges 65537": "--edges must be a whole number from 1 to 65536, not 65537",
    "--materials 65": "--materials must be a whole number from 1 to 64, not 65",
    "--tables 17": "--tables must be a whole number from 1 to 16, not 17",
    "--operand 11": "--operand must be 12 to 24 bits, not 11",
    "--operand 25": "--operand must be 12 to 24 bits, not 25",
    "--state 45": "--state must be 24 to 44 bits, not 45",
    "--operand 20": "--operand must be at most 18 bits, half of a state word, not 20",
    "--operand 12 --state 32": "--state must be at least 34 bits, as a list's entry has, not 32",
    "--family ice40": "--family must be ecp5 or generic or gowin or xilinx, not 'ice40'",
    "--lanes two": f"argument --lanes: must be a whole number, not 'two' {HELP}",
    "--lanes 1.5": f"argument --lanes: must be a whole number, not '1.5' {HELP}",
    "--lanes": f"argument --lanes: expected one argument {HELP}",
    "--speed 3": "unrecognized arguments: --speed 3 (see python -m hw --help)",
}


@pytest.fixture
def emitted(monkeypatch):
    """The parameters of every circuit that was emitted; the text is a stand-in's."""
    return record_circuits(monkeypatch)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "a" / "b"


def test_a_file_in_place_of_the_folder_is_refused(emitted, tmp_path, capsys):
    file = tmp_path / "file"
    file.write_text("")
    refused(["verilog", "--out", str(file)], f"--out must be a folder, not the file {file}", capsys)
    below = file / "folder"
    refused(
        ["verilog", "--out", str(below)],
        f"--out must be a folder that can be written, not {below}: Not a directory",
        capsys,
    )
    assert not emitted


@pytest.mark.parametrize("options", IMPOSSIBLE)
def test_an_impossible_option_is_one_line_of_error(options, emitted, out, capsys):
    refused(["verilog", "--out", str(out), *options.split()], IMPOSSIBLE[options], capsys)
    assert not emitted and not out.exists()


def test_progress_is_shown_only_on_a_terminal(emitted, out, capsys, monkeypatch):
    write_verilog(out)
    assert output(capsys)[1] == []
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    write_verilog(out, "--lanes", "1")
    error = capsys.readouterr().err
    assert error.startswith("writing the Verilog of 1 lane, 1 update, 16 nodes") and "\n" not in error
    assert error.split("\r")[1].strip() == "" and error.endswith("\r")


def test_an_interruption_is_reported(monkeypatch, capsys, out):
    def interrupt(parameters):
        raise KeyboardInterrupt

    monkeypatch.setattr(build, "emit", interrupt)
    assert write_verilog(out) == 130
    assert output(capsys) == ([], ["interrupted"])


def test_hw_runs_as_a_module():
    done = subprocess.run([sys.executable, "-m", "hw"], cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "error: the following arguments are required: "
        "verilog|lint|map|timing|bitstream|flash|doctor|docs (see python -m hw --help)\n"
    )
