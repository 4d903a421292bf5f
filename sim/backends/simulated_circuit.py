"""The emitted Verilog under Verilator, behind its host port."""

import ctypes
from pathlib import Path

import numpy as np

from hw.emit.verilog import LANE, TOP, emit
from hw.parameters import Parameters
from sim.backends.verilated import library, opened

SHIM = Path(__file__).with_name("shim.cpp")
CHUNK = 1_000_000
"""Cycles simulated per call; Python handles Ctrl-C between two calls."""


class SimulatedCircuit:
    """A simulated circuit behind its host port: a `sim.backends.circuit.Circuit`.

    Parameters
    ----------
    parameters : Parameters
    folder : Path
        Folder of the compiled circuits.
    waves : Path, optional
        A ``.vcd`` or ``.fst`` file for waveforms.

    Attributes
    ----------
    parameters : Parameters
    faults : list of str
        Names of the bits of its sticky faults.
    """

    def __init__(self, parameters: Parameters, folder: Path, waves: Path | None = None):
        self.parameters = parameters
        text, core = emit(parameters)
        self.faults = core.faults
        trace = waves.suffix[1:] if waves else None
        built = library(TOP, text, SHIM, folder=folder, repeated=LANE, trace=trace)
        shared = opened(built)
        self._new, self._delete = shared.circuit_new, shared.circuit_delete
        self._transact, self._wait, self._cycles = shared.circuit_transact, shared.circuit_wait, shared.circuit_cycles
        self._new.restype, self._new.argtypes = ctypes.c_void_p, [ctypes.c_char_p]
        self._transact.restype = ctypes.c_long
        self._transact.argtypes = [ctypes.c_void_p, ctypes.c_long, *[ctypes.c_void_p] * 5]
        self._wait.argtypes = [ctypes.c_void_p, ctypes.c_long]
        self._cycles.restype = ctypes.c_uint64
        for function in (self._delete, shared.circuit_reset, self._cycles):
            function.argtypes = [ctypes.c_void_p]
        self._handle = self._new(str(waves).encode() if waves else None)
        self._reset = shared.circuit_reset
        self.reset()

    def reset(self):
        """Reset the circuit; its memories keep their contents."""
        self._reset(self._handle)

    def close(self):
        """Free the simulated circuit and close the waveforms."""
        if self._handle:
            self._delete(self._handle)
            self._handle = None

    @property
    def clock(self) -> int:
        """Number of cycles simulated so far."""
        return self._cycles(self._handle)

    def transact(self, address, data, write) -> tuple[np.ndarray, np.ndarray]:
        """Make requests, one a cycle, and return (answers, errors). All arrays have the same length."""
        n = len(address)
        address, data = np.ascontiguousarray(address, np.uint32), np.ascontiguousarray(data, np.uint64)
        write = np.ascontiguousarray(write, np.uint8)
        answer, error = np.empty(n, np.uint64), np.empty(n, np.uint8)
        pointers = [a.ctypes.data for a in (address, data, write, answer, error)]
        got = self._transact(self._handle, n, *pointers)
        if got != n:
            raise RuntimeError(f"the circuit answered {got} of {n} requests")
        return answer, error

    def write(self, writes):
        """Write (address, data) pairs. Raises RuntimeError if one is refused."""
        pairs = list(writes)
        address, data = zip(*pairs, strict=True)
        _, error = self.transact(address, data, np.ones(len(pairs)))
        if error.any():
            raise RuntimeError(f"the circuit refused a write to {address[int(error.argmax())]:#x}")

    def read(self, addresses) -> np.ndarray:
        """Return (n,) unsigned words. Raises RuntimeError if a read is refused."""
        zeros = np.zeros(len(addresses))
        answer, error = self.transact(addresses, zeros, zeros)
        if error.any():
            raise RuntimeError(f"the circuit refused to read {addresses[int(error.argmax())]:#x}")
        return answer

    def run(self, cycles: int) -> bool:
        """Simulate so many cycles, or to the end of the run; return whether the run goes on."""
        return bool(self._wait(self._handle, cycles))

    def wait(self):
        """Simulate until the run is over."""
        while self.run(CHUNK):
            pass
