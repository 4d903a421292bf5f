"""A machine in a circuit, simulated or on a board, behind the circuit's host port."""

from collections import Counter
from collections.abc import Callable, Iterable
from typing import Protocol

import numpy as np

from golden.datapath.memory_image import MemoryImage
from golden.numbers.qformat import Q
from hw.map.control import Control
from hw.map.memory_map import NODE_FORCE, NODE_STATE, Map, Region
from hw.parameters import Parameters
from sim.encode.program import Program, Write


class Circuit(Protocol):
    """A circuit behind its host port: `sim.backends.simulated_circuit.SimulatedCircuit`,
    `sim.backends.link.board.Board`.

    Attributes
    ----------
    parameters : Parameters
    faults : list of str
        Names of the bits of its sticky faults.
    """

    parameters: Parameters
    faults: list[str]

    def write(self, writes: Iterable[Write]) -> None:
        """Write words, in this order."""

    def read(self, addresses: list[int]) -> np.ndarray:
        """Return (n,) unsigned words."""

    def run(self, cycles: int) -> bool:
        """Let the circuit run so many cycles, if it is simulated; return whether its run goes on."""

    def wait(self) -> None:
        """Return when its run is over."""

    def close(self) -> None:
        """Let go of it."""


class CircuitMachine:
    """A `sim.backends.machine.ClockedMachine` in a circuit that is loaded with an image.

    Parameters
    ----------
    verify : callable, optional
        Called with all (address, word) pairs that were written, after loading.

    Attributes
    ----------
    x, v, ratio, force, faults
        See `sim.backends.machine.Machine`; a fault counts 1 for each sticky flag that was set.
    cycles : int
        Clock cycles of all steps so far, by the circuit's own counter.

    Raises
    ------
    InputError
        If the circuit is too small for the image.
    """

    def __init__(self, image: MemoryImage, circuit: Circuit, verify: Callable[[list[Write]], object] | None = None):
        self._program = Program(image, circuit.parameters)
        self._map, self._formats = Map(circuit.parameters), image.formats
        self.circuit, self.parameters = circuit, circuit.parameters
        writes = [*self._program.load(), *self._program.start(image.v, image.x)]
        circuit.write([(self._control(Control.FAULTS), (1 << len(circuit.faults)) - 1), *writes])
        if verify:
            verify(writes)
        self.faults, self.cycles = Counter(), 0
        self.fetch()
        self.force = np.zeros_like(image.x)

    def restart(self, v: np.ndarray):
        """Go on with these velocities, and take up changes of the image's loads and masses."""
        self.circuit.write(self._program.start(v))
        self.v = v

    def take(self, image: MemoryImage):
        """Go on with an image that differs in materials, natural lengths and ratios."""
        self._program = Program(image, self.circuit.parameters)
        self.circuit.write(self._program.materials())
        self.ratio = image.ratio.copy()

    def step(self, steps: int = 1):
        """Let the circuit compute so many steps."""
        self.circuit.write([(self._control(Control.RUN), steps)])
        self.circuit.wait()
        self.fetch()
        cycles, faults = self.circuit.read([self._control(r) for r in (Control.CYCLES, Control.FAULTS)])
        self.cycles += int(cycles)
        self.faults |= Counter({name: 1 for bit, name in enumerate(self.circuit.faults) if int(faults) >> bit & 1})

    def close(self):
        """Let go of the circuit."""
        self.circuit.close()

    def _control(self, register):
        return self._map.address(Region.CONTROL, 0, register)

    def fetch(self):
        """Read the object's state; the circuit refuses while it runs."""
        names = (*NODE_STATE, *NODE_FORCE)
        addresses = [a for name in names for a in self._program.node_addresses(name)]
        nodes = self._signed(self.circuit.read(addresses)).reshape(len(names), -1).T
        self.x, self.v, self.force = (np.ascontiguousarray(nodes[:, k : k + 3]) for k in (0, 3, 6))
        self.ratio = self._signed(self.circuit.read(self._program.edge_addresses("ratio")))

    def _signed(self, words):
        return Q(self._formats.state, 0).from_bits(words.astype(np.int64))
