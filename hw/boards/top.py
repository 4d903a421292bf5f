"""A board's top: the circuit with its link, clock and reset."""

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
from hw.families.registry import get_family
from hw.link.top import Linked
from hw.parameters import Parameters

BOARD, CLOCK = "rheogate_board", "rheogate_clock"
"""Names of the board's top and of the module that makes its clock."""
ALWAYS = {"clk": In(1), "rx": In(1), "tx": Out(1, init=1)}
OPTIONAL = {"reset": In(1), "busy": Out(1), "locked": Out(1)}
HOLD_CYCLES = 16
"""Cycles that the reset lasts after its cause."""


class HeldReset(wiring.Component):
    """A reset that begins before there is a clock, and ends `HOLD_CYCLES` after its cause. Its registers start in
    reset and have no reset themselves.

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
        left = Signal(range(HOLD_CYCLES), init=HOLD_CYCLES - 1, reset_less=True)
        held = Signal(init=1, reset_less=True)
        m.submodules.asked = FFSynchronizer(self.cause, asked, init=1)
        with m.If(asked):
            m.d.sync += [left.eq(HOLD_CYCLES - 1), held.eq(1)]
        with m.Elif(left != 0):
            m.d.sync += left.eq(left - 1)
        with m.Else():
            m.d.sync += held.eq(0)
        m.d.comb += self.reset.eq(held)
        return m


class BoardTop(wiring.Component):
    """The circuit and its link, with the board's clock. It is in reset while the PLL isn't locked or the button is
    pressed, and `HOLD_CYCLES` after that.

    Members
    -------
    clk : In(1)
        The board's oscillator.
    rx : In(1), tx : Out(1)
        The serial line.
    reset : In(1), busy : Out(1), locked : Out(1)
        Where the board has them: a button, a light that is on while steps are run, one that is on while the PLL is
        locked.
    """

    def __init__(self, board: Board, linked: Linked):
        self._pins, self._linked = board.ports, linked
        super().__init__({**ALWAYS, **{name: port for name, port in OPTIONAL.items() if name in board.ports}})

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
        if "busy" in self._pins:
            m.d.comb += self.busy.eq(self._active("busy", linked.busy))
        if "locked" in self._pins:
            m.d.comb += self.locked.eq(self._active("locked", locked))
        return m

    def _active(self, name, value):
        """Convert between active high in the circuit and the polarity of the pin."""
        return ~value if self._pins[name].active_low else value


def board_top(board: Board, parameters: Parameters) -> tuple[str, float]:
    """Return the Verilog text with the module `BOARD`, and its clock in MHz.

    Raises
    ------
    InputError
        If the PLL can't make the board's clock, the clock can't make its baud rate, or pins and ports don't match.
    """
    clock, mhz = get_family(board.family).pll.verilog(CLOCK, board.oscillator_mhz, board.clock_mhz)
    text, core = emit(parameters)
    try:
        linked = Linked(core, clock_hz=round(mhz * 1e6), baud=board.baud)
    except ValueError as error:
        raise InputError(str(error)) from None
    top = convert(BoardTop(board, linked), BOARD)
    check(board.ports, top, BOARD)
    return "\n".join([text, emit_link(linked, parameters.family), clock, top]), mhz
