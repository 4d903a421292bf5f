"""What is on a board: the circuit behind its link, the clock that it runs at, and its reset."""

from amaranth.hdl import ClockDomain, ClockSignal, Instance, Module, ResetSignal, Signal
from amaranth.lib import wiring
from amaranth.lib.cdc import FFSynchronizer
from amaranth.lib.wiring import In, Out

from golden.support.errors import InputError
from hw.blocks.placed import Placed
from hw.boards.board import Board
from hw.boards.pins import check
from hw.emit.linked import LINKED, emit_link
from hw.emit.verilog import convert, emit
from hw.families import no_pll as none
from hw.families.ecp5 import pll as ecp5
from hw.families.xilinx import pll as xilinx
from hw.link.top import Linked
from hw.parameters import Parameters

BOARD, CLOCK = "rheogate_board", "rheogate_clock"
"""Names of the board's top and of the module that makes its clock."""
PLLS = {"ecp5": ecp5, "gowin": none, "xilinx": xilinx}
ALWAYS = {"clk": In(1), "rx": In(1), "tx": Out(1, init=1)}
IF_THERE = {"reset": In(1), "busy": Out(1), "locked": Out(1)}
HELD = 16
"""Cycles that the reset lasts after its cause is gone."""


class HeldReset(wiring.Component):
    """A reset that begins before there is a clock, and ends `HELD` cycles after its cause. Its registers start as in a
    reset and have none themselves.

    Members
    -------
    cause : In(1)
        Asynchronous.
    reset : Out(1)
    """

    def __init__(self):
        super().__init__({"cause": In(1), "reset": Out(1)})

    def elaborate(self, platform):
        m = Module()
        asked = Signal(init=1)
        left = Signal(range(HELD), init=HELD - 1, reset_less=True)
        held = Signal(init=1, reset_less=True)
        m.submodules.asked = FFSynchronizer(self.cause, asked, init=1)
        with m.If(asked):
            m.d.sync += [left.eq(HELD - 1), held.eq(1)]
        with m.Elif(left != 0):
            m.d.sync += left.eq(left - 1)
        with m.Else():
            m.d.sync += held.eq(0)
        m.d.comb += self.reset.eq(held)
        return m


class BoardTop(wiring.Component):
    """The circuit behind its link with the board's clock. It is reset as long as the PLL isn't locked or the button is
    pressed, and `HELD` cycles more.

    Members
    -------
    clk : In(1)
        Of the board's oscillator.
    rx : In(1), tx : Out(1)
        The line.
    reset : In(1), busy : Out(1), locked : Out(1)
        A button, and lights for steps that are run and for a clock that is stable; where the board has them.
    """

    def __init__(self, board: Board, linked: Linked):
        self._pins, self._linked = board.ports, linked
        super().__init__({**ALWAYS, **{name: port for name, port in IF_THERE.items() if name in board.ports}})

    def elaborate(self, platform):
        m = Module()
        m.domains.sync = ClockDomain()
        clock = Signal(name="system_clock")
        locked = Signal(name="pll_locked")
        m.submodules.clock = Instance(CLOCK, i_oscillator=self.clk, o_clock=clock, o_locked=locked)
        m.submodules.held = held = HeldReset()
        button = self._active("reset", self.reset) if "reset" in self._pins else 0
        m.d.comb += [held.cause.eq(~locked | button), ClockSignal().eq(clock), ResetSignal().eq(held.reset)]
        m.submodules.linked = linked = Placed(LINKED, self._linked.signature)
        m.d.comb += [linked.rx.eq(self.rx), self.tx.eq(linked.tx)]
        for name, state in (("busy", linked.busy), ("locked", locked)):
            if name in self._pins:
                m.d.comb += getattr(self, name).eq(self._active(name, state))
        return m

    def _active(self, name, value):
        return ~value if self._pins[name].active_low else value


def board_top(board: Board, parameters: Parameters) -> tuple[str, float]:
    """(the Verilog text with the module `BOARD`, its clock in MHz).

    Raises
    ------
    InputError
        If the PLL can't make the board's clock, the clock can't make its baud rate, or pins and ports don't match.
    """
    clock, mhz = PLLS[board.family].verilog(CLOCK, board.oscillator_mhz, board.clock_mhz)
    text, core = emit(parameters)
    try:
        linked = Linked(core, clock_hz=round(mhz * 1e6), baud=board.baud)
    except ValueError as error:
        raise InputError(str(error)) from None
    top = convert(BoardTop(board, linked), BOARD)
    check(board.ports, top, BOARD)
    return "\n".join([text, emit_link(linked, parameters.family), clock, top]), mhz
