"""The circuit behind its link: two wires are all that leads to it."""

from amaranth.hdl import Cat, Module, ResetSignal, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.emit.verilog import TOP, Placed, convert, emit
from hw.families import FAMILIES
from hw.link.description import key
from hw.link.device import Device
from hw.link.identity import Identity
from hw.link.uart import Receiver, Transmitter, cycles_per_bit
from hw.machine.core import Core
from hw.machine.host_port import host_signature
from hw.parameters import Parameters

LINKED = "rheogate_linked"


class Linked(wiring.Component):
    """A circuit, the device that does what comes over the link, and the line.

    Parameters
    ----------
    core : Core
        Placed as an instance of its own Verilog module.
    clock_hz : int
    baud : int

    Members
    -------
    rx : In(1), tx : Out(1)
        The line, 1 when idle; ``rx`` is asynchronous.
    busy : Out(1)
        Steps are run.

    Raises
    ------
    ValueError
        As `hw.link.uart.cycles_per_bit`.
    """

    def __init__(self, core: Core, *, clock_hz: int, baud: int):
        self._core, self._bit_cycles = core, cycles_per_bit(clock_hz, baud)
        self.key = key(core.parameters)
        self.identity = Identity.of(core.parameters, self.key, clock_hz, self._bit_cycles)
        super().__init__({"rx": In(1), "tx": Out(1, init=1), "busy": Out(1)})

    def elaborate(self, platform):
        m, state = Module(), self._core.parameters.formats.state
        m.submodules.core = core = Placed(TOP, self._core.signature)
        m.submodules.device = device = Device(key=self.key, identity=self.identity.items, state=state)
        m.submodules.receiver = receiver = Receiver(self._bit_cycles)
        m.submodules.transmitter = transmitter = Transmitter(self._bit_cycles)
        # Much hangs on the reset of each of them, and they are far from one another
        core.reset, device.reset = near = [
            Signal(name=f"{name}_reset", init=1, reset_less=True) for name in ("core", "device")
        ]
        m.d.sync += Cat(near).eq(Cat(ResetSignal(), near[0]))
        m.d.comb += [
            receiver.rx.eq(self.rx),
            self.tx.eq(transmitter.tx),
            self.busy.eq(core.busy),
            device.busy.eq(core.busy),
            transmitter.valid.eq(device.out_valid),
            transmitter.data.eq(device.out_data),
            device.out_ready.eq(transmitter.ready),
            *(getattr(device, name).eq(getattr(receiver, name)) for name in ("valid", "data", "error", "broken")),
        ]
        for name, member in host_signature(state).items():
            here, there = getattr(core, name), getattr(device, f"port_{name}")
            m.d.comb += here.eq(there) if member.flow == In else there.eq(here)
        return m


def linked(parameters: Parameters, *, clock_hz: int, baud: int) -> tuple[str, Linked]:
    """(the Verilog text with the module `LINKED`, what it was made from). Raises ValueError as `Linked`."""
    text, core = emit(parameters)
    top = Linked(core, clock_hz=clock_hz, baud=baud)
    return f"{text}\n{convert(top, LINKED, FAMILIES[parameters.family])}", top
