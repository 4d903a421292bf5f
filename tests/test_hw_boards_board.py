"""The boards' files: each is a board, and each mistake in one is a line."""

import copy
import json
import tomllib

import pytest

from golden.support.errors import InputError
from hw.boards import board as boards
from hw.sizes import SIZES

TEXT = (boards.FOLDER / "ulx3s-85f.toml").read_text()
DOCUMENT = tomllib.loads(TEXT)


@pytest.fixture
def refused(tmp_path):
    """A function that expects exactly this message, after the file's name, for the text of a board's file."""

    def check(text: str, message: str):
        path = tmp_path / "mine.toml"
        path.write_text(text)
        with pytest.raises(InputError) as caught:
            boards.load("mine", tmp_path)
        assert str(caught.value) == f"{path}: {message}"

    return check


@pytest.mark.parametrize("name", boards.names())
def test_every_file_is_a_board(name):
    board = boards.load(name)
    assert board.parameters().family == board.family


def test_a_board_has_its_circuit_and_takes_another():
    board = boards.load("ulx3s-85f")
    assert board.parameters().lanes == DOCUMENT["circuit"]["lanes"]
    assert board.parameters(lanes=None) == board.parameters()
    chosen = board.parameters(lanes=2, tables=1)
    assert (chosen.lanes, chosen.tables, chosen.nodes) == (2, 1, board.circuit.nodes)


def test_a_circuit_has_all_sizes_of_parameters():
    assert list(boards.Circuit.__struct_fields__) == list(SIZES)


def test_an_unknown_board_lists_those_known():
    with pytest.raises(InputError, match=f"^--board must be {' or '.join(boards.names())}, not 'ulx3s'$"):
        boards.load("ulx3s")


def keys(table, path=()):
    for key, value in table.items():
        yield (*path, key)
        if isinstance(value, dict):
            yield from keys(value, (*path, key))


KEYS = {".".join(path): path for path in keys(DOCUMENT)}
LISTED = {str: "text", int: "a whole number", float: "a number", dict: "a table"}


def text_of(document, path=()) -> str:
    """TOML of values and tables."""
    lines = [f"{key} = {json.dumps(value)}" for key, value in document.items() if not isinstance(value, dict)]
    for key, value in document.items():
        if isinstance(value, dict):
            inner = (*path, key)
            lines += [f"[{'.'.join(inner)}]", text_of(value, inner)]
    return "\n".join(lines)


def optional(path) -> bool:
    return path[0] == "pins" and path[-1] in ("reset", "busy", "locked", "pull", "drive", "active_low")


@pytest.mark.parametrize("path", KEYS)
def test_a_key_that_is_missing_or_of_another_type(path, refused):
    document = copy.deepcopy(DOCUMENT)
    *tables, key = KEYS[path]
    table = document
    for name in tables:
        table = table[name]
    value = table.pop(key)
    if not optional(KEYS[path]):
        refused(text_of(document), f"{path} must be given")
    table[key] = []
    refused(text_of(document), f"{path} must be {LISTED[type(value)]}, not a list")


@pytest.mark.parametrize(
    "old, new, message",
    [
        ('family = "ecp5"', 'family = "ecp4"', "family must be ecp5 or gowin or xilinx, not 'ecp4'"),
        ('family = "ecp5"', "family = 5", "family must be text, not 5"),
        ('device = "85k"', 'device = "86k"', "device must be 12k or 25k or 45k or 85k, not '86k'"),
        ("grade = 6", "grade = 0", "grade must be a whole number of at least 1, not 0"),
        ("target_mhz = 150.0", "target_mhz = 0.0", "target_mhz must be a number above 0, not 0.0"),
        ("target_mhz = 150.0", "target_mhz = inf", "target_mhz must be a finite number, not inf"),
        ("grade = 6", "grade = 7", "grade must be 6, not 7"),
        ('pull = "down"', 'pull = "off"', "pins.reset.pull must be none or up or down, not 'off'"),
        ('pin = "M1"', 'pin = "G2"', "pins.rx.pin must be another one than that of clk, not 'G2'"),
        (
            "locked =",
            "ready =",
            "pins.ready must not be there: the keys known here are clk, rx, tx, reset, busy, locked",
        ),
        ("lanes = 4", "lanes = 99", "circuit.lanes must be a whole number from 1 to 6, not 99"),
        ("lanes = 4", "lanes = 4.5", "circuit.lanes must be a whole number, not 4.5"),
        (
            "grade = 6",
            "grade = 6\nspeed = 6",
            "speed must not be there: the keys known here are family, device, package, "
            "grade, target_mhz, oscillator_mhz, clock_mhz, baud, loader, pins, circuit, no_wide_luts",
        ),
        ("nodes = 512", "", "circuit.nodes must be given"),
        ('family = "ecp5"', 'family = "generic"', "family must be ecp5 or gowin or xilinx, not 'generic'"),
        (
            "lanes = 4",
            "lines = 1\nlanes = 4",
            f"circuit.lines must not be there: the keys known here are {', '.join(SIZES)}",
        ),
    ],
)
def test_a_value_that_is_wrong(old, new, message, refused):
    assert TEXT.count(old) == 1
    high = SIZES["lanes"].allowed[-1]
    refused(TEXT.replace(old, new), message.replace("to 6,", f"to {high},"))


def test_a_file_that_is_no_toml(refused):
    error = "Expected '=' after a key in a key/value pair (at end of document)"
    refused("family", f"the board must be a TOML file: {error}")
