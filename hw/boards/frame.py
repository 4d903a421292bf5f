"""A frame for static timing: the circuit's ports on shift registers, so that no path goes to a pin."""

from amaranth.hdl import Cat, ClockDomain, ClockSignal, Module, ResetSignal, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.placed import Placed
from hw.emit.verilog import TOP, convert, emit
from hw.machine.core import Core
from hw.parameters import Parameters

FRAME, CORE = "timing", "core"
"""Names of the frame's module and of the circuit's instance in it."""


class Frame(wiring.Component):
    """The circuit between two shift registers: every input is a bit of one, every output goes into a bit of the other.
    So synthesis removes nothing, and every timed path is the circuit's own or like one to a host on the same device.

    Members
    -------
    clk, reset, serial_in : In(1)
        ``reset`` passes two registers, as on a board.
    serial_out : Out(1)
    """

    def __init__(self, core: Core):
        self._core = core
        super().__init__({"clk": In(1), "reset": In(1), "serial_in": In(1), "serial_out": Out(1)})

    def elaborate(self, platform):
        m = Module()
        m.domains.sync = ClockDomain()
        reset = Signal(2, reset_less=True, name="reset_registers")
        m.d.sync += reset.eq(Cat(self.reset, reset))
        m.d.comb += [ClockSignal().eq(self.clk), ResetSignal().eq(reset[1])]

        m.submodules[CORE] = core = Placed(TOP, self._core.signature)
        ports = [(member.flow, port) for _, member, port in core.signature.flatten(core)]
        inputs, outputs = (Cat(port for flow, port in ports if flow == wanted) for wanted in (In, Out))
        feed = Signal(len(inputs), reset_less=True)
        gathered = Signal(len(outputs), reset_less=True)
        m.d.sync += [feed.eq(Cat(self.serial_in, feed)), gathered.eq(Cat(feed[-1], gathered) ^ outputs)]
        m.d.comb += [inputs.eq(feed), self.serial_out.eq(gathered[-1])]
        return m


def framed(parameters: Parameters) -> str:
    """Return the Verilog of the circuit in its frame, the module `FRAME`."""
    text, core = emit(parameters)
    return f"{text}\n{convert(Frame(core), FRAME)}"
