"""A board's top: its ports against every board's pins, its reset, and what it refuses."""

import copy
import re

import pytest
from hw_objects import core_to_ask, only_asked, simulate

from golden.support.errors import InputError
from hw.boards import board as boards
from hw.boards import pins
from hw.boards import top as board_top
from hw.boards.flow import SMALLEST
from hw.boards.top import BOARD, HOLD_CYCLES, BoardTop, HeldReset
from hw.emit.verilog import convert
from hw.families.target import Pin
from hw.link.top import Linked
from hw.parameters import Parameters

SMALL = Parameters(**SMALLEST)


@pytest.fixture(scope="module")
def linked():
    with only_asked():
        made = Linked(core_to_ask(SMALL), clock_hz=50_000_000, baud=115_200)
    made._MustUse__used = True  # it is only asked
    return made


def top(board, linked) -> str:
    return convert(BoardTop(board, linked), BOARD)


@pytest.mark.parametrize("name", boards.names())
def test_every_boards_pins_are_the_ports_of_its_top(name, linked):
    board = boards.load(name)
    text = top(board, linked)
    assert pins.directions(text, BOARD) == {
        "clk": "in",
        "rx": "in",
        "tx": "out",
        "reset": "in",
        "busy": "out",
        "locked": "out",
    }
    pins.check(board.ports, text, BOARD)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda ports: ports.pop("tx"), f"pins.tx must be given: {BOARD} has that port"),
        (
            lambda ports: ports.update(ready=Pin("A1", "LVCMOS33")),
            f"pins.ready must not be there: the ports of {BOARD} are busy, clk, locked, reset, rx, tx",
        ),
        (
            lambda ports: ports.update(rx=Pin("A1", "LVCMOS33", drive=4)),
            "pins.rx.drive must be of an output, which rx is not",
        ),
    ],
)
def test_pins_that_are_not_the_ports_are_refused(change, message, linked):
    board = boards.load("ulx3s-85f")
    ports = dict(board.ports)
    change(ports)
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        pins.check(ports, top(board, linked), BOARD)


def test_a_board_without_button_and_lights_has_no_ports_for_them(linked):
    board = boards.load("ulx3s-85f")
    board.pins.reset = board.pins.busy = board.pins.locked = None
    assert pins.directions(top(board, linked), BOARD).keys() == {"clk", "rx", "tx"}


def test_lights_and_buttons_may_be_active_low(linked):
    board = boards.load("ulx3s-85f")
    high = top(board, linked)
    for pin in (board.pins.reset, board.pins.busy):
        pin.active_low = True
    low = top(board, linked)
    assert "assign busy = ~ linked_busy;" in low and "assign busy = ~" not in high
    assert "= ~ reset;" in low and "~ reset" not in high


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        (
            "clock_mhz",
            137.3,
            "clock_mhz must be a frequency that a PLL of ecp5 makes of 25 MHz, as 135 or 137.5, not 137.3",
        ),
        ("baud", 9600, "baud must be 115200 to 3000000, not 9600"),
    ],
)
def test_a_clock_or_a_rate_that_cannot_be_is_refused(key, value, message, monkeypatch):
    monkeypatch.setattr(board_top, "emit", lambda parameters: ("", core_to_ask(parameters)))
    board = copy.deepcopy(boards.load("ulx3s-85f"))
    setattr(board, key, value)
    with only_asked(), pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        board_top.board_top(board, SMALL)


def test_the_circuit_is_told_the_clock_that_the_pll_gives():
    board = boards.load("ulx3s-85f")
    board.clock_mhz = 100.00001
    text, mhz = board_top.board_top(board, SMALL)
    assert mhz == 100
    for module in ("rheogate", "rheogate_lane", "rheogate_linked", board_top.CLOCK, BOARD):
        assert len(re.findall(rf"^module {module}\(", text, re.MULTILINE)) == 1, module


def test_a_reset_begins_before_the_clock_and_outlasts_its_cause():
    seen = []

    async def bench(ctx):
        for cycle in range(100):
            ctx.set(dut.cause, cycle < 5 or cycle == 50)
            seen.append(ctx.get(dut.reset))
            await ctx.tick()

    dut = HeldReset()
    simulate(dut, bench)
    falls = [n for n in range(1, 100) if (seen[n - 1], seen[n]) == (1, 0)]
    rises = [n for n in range(1, 100) if (seen[n - 1], seen[n]) == (0, 1)]
    assert seen[0] == 1 and len(falls) == 2 and len(rises) == 1
    assert falls[0] - 5 == falls[1] - 51 >= HOLD_CYCLES and 50 < rises[0] <= 54
