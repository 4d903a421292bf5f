"""The circuit with its link: a host reaches it over two wires."""

from amaranth.hdl import Cat, Module, ResetSignal, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.placed import Placed
from hw.link.description import key
from hw.link.device import Device, members
from hw.link.identity import Identity
from hw.link.uart import Receiver, Transmitter, cycles_per_bit
from hw.machine.core import TOP, Core

DEVICE = "rheogate_device"
"""The Verilog module of the device."""


class Linked(wiring.Component):
    """A circuit, the device that answers a host's commands, and the serial line.

    Parameters
    ----------
    core : Core
        It becomes an instance of its own Verilog module, and so does the device.
    clock_hz : int
    baud : int

    Members
    -------
    rx : In(1), tx : Out(1)
        The line, 1 when idle; ``rx`` is asynchronous.
    busy : Out(1)
        A run is under way.

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

    def device(self) -> Device:
        """Return the device, for its own module."""
        return Device(key=self.key, identity=self.identity.items, state=self._core.parameters.formats.state)

    def elaborate(self, platform):
        m, state = Module(), self._core.parameters.formats.state
        # A reset register for each of the two: they may be placed far apart, and a reset has a large fan-out
        core_reset, device_reset = resets = [
            Signal(name=f"{name}_reset", init=1, reset_less=True) for name in ("core", "device")
        ]
        m.d.sync += Cat(resets).eq(Cat(ResetSignal(), core_reset))
        m.submodules.core = core = Placed(TOP, self._core.signature, reset=core_reset)
        m.submodules.device = device = Placed(DEVICE, members(state), reset=device_reset)
        m.submodules.receiver = receiver = Receiver(self._bit_cycles)
        m.submodules.transmitter = transmitter = Transmitter(self._bit_cycles)
        wiring.connect(m, device.port, core)
        wiring.connect(m, receiver.received, device.received)
        wiring.connect(m, device.sent, transmitter.bytes)
        m.d.comb += [
            receiver.rx.eq(self.rx),
            self.tx.eq(transmitter.tx),
            self.busy.eq(core.busy),
        ]
        return m
