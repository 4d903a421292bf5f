"""The emitted Verilog, simulated: the same face as `golden.machine.Machine`."""

import ctypes
from collections import Counter
from pathlib import Path

import numpy as np

from golden.image import Image
from hw.parameters import Parameters
from hw.registers import NODE_FORCE, NODE_STATE, Control, Map, Region
from hw.verilog import LANE, TOP, emit

from .program import Program
from .verilated import library, opened

SHIM = Path(__file__).with_name("shim.cpp")
CHUNK = 1_000_000
"""Cycles simulated per call: a Ctrl-C is heard in between."""


class Circuit:
    """A simulated circuit behind its host port.

    Parameters
    ----------
    parameters : Parameters
    folder : Path
        Where compiled circuits are kept.
    waves : Path, optional
        A ``.vcd`` or ``.fst`` file to record to.
    """

    def __init__(self, parameters: Parameters, folder: Path, waves: Path | None = None):
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
        self._reset(self._handle)

    def close(self):
        if self._handle:
            self._delete(self._handle)
            self._handle = None

    @property
    def clock(self) -> int:
        """Cycles simulated so far."""
        return self._cycles(self._handle)

    def transact(self, address, data, write) -> tuple[np.ndarray, np.ndarray]:
        """(answers, errors) of requests, one a cycle. Arrays of equal length."""
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
        """(address, data) pairs. Raises RuntimeError if one is refused."""
        pairs = list(writes)
        address, data = zip(*pairs, strict=True)
        _, error = self.transact(address, data, np.ones(len(pairs)))
        if error.any():
            raise RuntimeError(f"the circuit refused a write to {address[int(error.argmax())]:#x}")

    def read(self, addresses) -> np.ndarray:
        """(n,) unsigned words. Raises RuntimeError if a read is refused."""
        zeros = np.zeros(len(addresses))
        answer, error = self.transact(addresses, zeros, zeros)
        if error.any():
            raise RuntimeError(f"the circuit refused to read {addresses[int(error.argmax())]:#x}")
        return answer

    def run(self, cycles: int) -> bool:
        """Simulate so many cycles, or to the end of the run; whether it goes on."""
        return bool(self._wait(self._handle, cycles))

    def wait(self):
        """Simulate until the run is over."""
        while self.run(CHUNK):
            pass


class RtlMachine:
    """The simulated circuit loaded with an image.

    Attributes
    ----------
    x, v, ratio, force, faults
        As of `golden.machine.Machine`; a fault counts 1 for each sticky flag that was set.
    cycles : int
        Clock cycles of all steps so far, by the circuit's own counter.
    """

    def __init__(self, image: Image, *, parameters: Parameters, folder: Path, waves: Path | None = None):
        self._program = Program(image, parameters)
        self._map, self._formats = Map(parameters), image.formats
        self.circuit = Circuit(parameters, folder, waves)
        self.circuit.write(self._program.load())
        self.circuit.write(self._program.start(image.v, image.x))
        self.faults, self.cycles = Counter(), 0
        self.fetch()
        self.force = np.zeros_like(image.x)

    def restart(self, v: np.ndarray):
        """New velocities, and the image's loads and masses as they are now."""
        self.circuit.write(self._program.start(v))
        self.v = v

    def step(self, steps: int = 1):
        self.circuit.write([(self._control(Control.RUN), steps)])
        self.circuit.wait()
        self.fetch()
        cycles, faults = self.circuit.read([self._control(r) for r in (Control.CYCLES, Control.FAULTS)])
        self.cycles += int(cycles)
        self.faults |= Counter({name: 1 for bit, name in enumerate(self.circuit.faults) if int(faults) >> bit & 1})

    def close(self):
        self.circuit.close()

    def _control(self, register):
        return self._map.address(Region.CONTROL, 0, register)

    def fetch(self):
        """Read the object's state as the circuit has it now; refused while it runs."""
        names = (*NODE_STATE, *NODE_FORCE)
        addresses = [a for name in names for a in self._program.node_addresses(name)]
        nodes = self._signed(self.circuit.read(addresses)).reshape(len(names), -1).T
        self.x, self.v, self.force = (np.ascontiguousarray(nodes[:, k : k + 3]) for k in (0, 3, 6))
        self.ratio = self._signed(self.circuit.read(self._program.edge_addresses("ratio")))

    def _signed(self, words):
        top = 1 << self._formats.state - 1
        return (words.astype(np.int64) ^ top) - top
