"""The whole circuit under Verilator, driven through its serial pins."""

from __future__ import annotations

import ctypes
from pathlib import Path

from hw.emit.linked import LINKED, linked
from hw.emit.verilog import LANE
from hw.parameters import Parameters
from sim.backends.verilated import library, opened

SHIM = Path(__file__).with_name("serial.cpp")
ROOM = 1 << 16
CLOCK_HZ, BAUD = 24_000_000, 3_000_000
"""The fewest cycles a bit that the receiver allows, because each takes time to simulate."""


class SerialCircuit:
    """A simulated circuit, as a host sees it over the line.

    Parameters
    ----------
    parameters : Parameters
    clock_hz, baud : int
        Only their ratio matters: the cycles of a bit.
    folder : Path
        Compiled circuits are kept there.
    host_error : float
        Relative error of the host's rate; positive if it is too high.

    Attributes
    ----------
    linked : hw.link.top.Linked
        The circuit's source.
    """

    def __init__(self, parameters: Parameters, *, clock_hz: int, baud: int, folder: Path, host_error: float = 0.0):
        text, self.linked = linked(parameters, clock_hz=clock_hz, baud=baud)
        shared = opened(library(LINKED, text, SHIM, folder=folder, repeated=LANE))
        self._shared, pointer, number = shared, ctypes.c_void_p, ctypes.c_long
        shared.serial_new.restype, shared.serial_new.argtypes = pointer, [ctypes.c_double, ctypes.c_int]
        shared.serial_run.restype = number
        shared.serial_run.argtypes = [pointer, ctypes.c_char_p, number, number, ctypes.c_char_p, number]
        shared.serial_cycles.restype = ctypes.c_uint64
        for function in (shared.serial_delete, shared.serial_reset, shared.serial_cycles, shared.serial_idle):
            function.argtypes = [pointer]
        cycles = self.linked.identity.bit_cycles
        self._handle = shared.serial_new(cycles / (1 + host_error), cycles)
        self._out = ctypes.create_string_buffer(ROOM)

    def run(self, data: bytes, cycles: int) -> bytes:
        """Send ``data`` after earlier bytes, run so many cycles, and return the bytes that came."""
        came = self._shared.serial_run(self._handle, data, len(data), cycles, self._out, ROOM)
        return self._out.raw[:came]

    @property
    def idle(self) -> bool:
        """True if nothing is on the line and no run is under way."""
        return bool(self._shared.serial_idle(self._handle))

    @property
    def clock(self) -> int:
        """Cycles simulated so far."""
        return self._shared.serial_cycles(self._handle)

    def reset(self):
        self._shared.serial_reset(self._handle)

    def close(self):
        if self._handle:
            self._shared.serial_delete(self._handle)
            self._handle = None
