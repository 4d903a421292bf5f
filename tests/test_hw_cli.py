"""``python -m hw``: every mistake is one line that names the option, and exit code 2."""

import pytest

from hw.__main__ import main

FORMATS = "(see python -m hw verilog --help)"


@pytest.mark.parametrize("options, message", [
    (["--lanes", "0"], "--lanes must be a whole number from 1 to 8, not 0"),
    (["--lanes", "two"], f"argument --lanes: must be a whole number, not 'two' {FORMATS}"),
    (["--nodes", "5000"], "--nodes must be a whole number from 2 to 4096, not 5000"),
    (["--edges", "-1"], "--edges must be a whole number from 1 to 65536, not -1"),
    (["--materials", "65"], "--materials must be a whole number from 1 to 64, not 65"),
    (["--tables", "17"], "--tables must be a whole number from 1 to 16, not 17"),
    (["--operand", "40"], "--operand must be 12 to 24 bits, not 40"),
    (["--operand", "20"], "--operand must be at most 18 bits, half of a state word, not 20"),
    (["--state", "80"], "--state must be 24 to 44 bits, not 80"),
    (["--operand", "16", "--state", "32"], "--state must be at least 33 bits, as a list's entry has, not 32"),
    (["--lane", "1", "--speed"], f"unrecognized arguments: --speed {FORMATS.replace('hw verilog', 'hw')}"),
])
def test_mistakes(options, message, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["verilog", *options, "--out", str(out)]) == 2
    assert capsys.readouterr().err == f"error: {message}\n"
    assert not out.exists()


def test_a_file_in_place_of_the_folder(tmp_path, capsys):
    (tmp_path / "out").write_text("mine")
    assert main(["verilog", "--out", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err == f"error: --out must be a folder, not the file {tmp_path / 'out'}\n"
    assert (tmp_path / "out").read_text() == "mine"


@pytest.mark.parametrize("name", ["rheogate.v", "manifest.json"])
def test_somebody_elses_file_stays(name, tmp_path, capsys):
    (tmp_path / name).write_text("mine")
    assert main(["verilog", "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith(f"error: --out must be a folder without another tool's {name}, not ")
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "mine"
