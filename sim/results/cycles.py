"""The cycle model: the cycles of a run, exactly as the circuit counts them, from the lists of edges and nodes alone.

Times are cycles from the first of the run. Rows of edges and rows of nodes are issued in the order of their lists, one
a cycle (nodes one in three cycles if an updater takes their axes one by one). The time of an entry is therefore its
index in the list plus the longest delay of the entries before it.
"""

import numpy as np

from golden.datapath.memory_image import MemoryImage
from golden.datapath.rk4 import RK4
from golden.physics.scene import Scene
from golden.support.errors import InputError
from hw.machine.issue_register import LATENCY as ISSUE_LATENCY
from hw.machine.latency import Latencies
from hw.parameters import Parameters
from sim.encode import limits
from sim.encode.program import Program

UNTIL_SETTLED = 50
"""Steps after which the lengths of steps repeat."""


class Wavefront:
    """The times at which the rows of edges and nodes of an object are issued in a circuit.

    Raises
    ------
    golden.support.errors.InputError
        If the circuit is too small for the object (`sim.encode.program.Program`).
    """

    def __init__(self, image: MemoryImage, parameters: Parameters, latencies: Latencies | None = None):
        program = Program(image, parameters)
        self.latencies = latencies or Latencies.of(parameters)
        self.rows, self.edges, self._lanes = program.rows, len(image.edges), parameters.lanes
        self._pace = parameters.cycles_per_node
        self._highest, self._need = program.highest(), program.need()
        self._need[-1] = self.rows  # the last row of nodes ends the stage

    def run(self, steps: int) -> np.ndarray:
        """Return (steps,) the first cycle after each step of a run; the last is the value of the circuit's counter."""
        updated = np.full(len(self._need), 0)
        last_row, last_node = self.latencies.rows - 1, self.latencies.nodes - self._pace
        ends = []
        for stage in range(steps * RK4.stages):
            rows = issue_times(updated[self._highest] if stage else np.zeros(self.rows, np.int64), last_row + 1)
            summed = np.concatenate([[0], rows + self.latencies.edge])
            nodes = issue_times(summed[self._need], last_node + self._pace, self._pace)
            updated = nodes + self.latencies.node
            last_row, last_node = rows[-1], nodes[-1]
            ends += [updated[-1] - ISSUE_LATENCY] if stage % RK4.stages == RK4.stages - 1 else []
        return np.array(ends)

    def per_step(self) -> int:
        """Return the cycles of a step: a run of n + 1 steps takes so many more than one of n, once n is large.

        Raises
        ------
        ValueError
            If steps have different lengths even then.
        """
        lengths = np.diff(self.run(UNTIL_SETTLED))[UNTIL_SETTLED // 2 :]
        if (lengths != lengths[0]).any():
            raise ValueError(f"steps must take the same number of cycles, not {sorted(set(lengths.tolist()))}")
        return int(lengths[0])

    def occupancy(self) -> float:
        """Return the edges issued per lane and cycle."""
        return RK4.stages * self.edges / (self._lanes * self.per_step())


def issue_times(ready: np.ndarray, first: int, pace: int = 1) -> np.ndarray:
    """Return the cycle in which each entry of a list is issued: in order, when it is ``ready``, at most one every
    ``pace`` cycles, none before ``first``."""
    earliest = pace * np.arange(len(ready))
    return earliest + np.maximum.accumulate(np.maximum(ready - earliest, first))


def cycles_per_step(scene: Scene, lanes: int, updates: int) -> int:
    """Return the cycles of a step of a scene's object in a circuit that has room for it.

    Raises
    ------
    InputError
        If there is no such circuit, or it could not hold the scene at any capacity.
    """
    image = limits.encode_checked(scene).image
    room = {"nodes": max(2, image.nodes), "edges": len(image.edges), "materials": len(image.materials)}
    try:
        parameters = Parameters(lanes=lanes, updates=updates, **room)
    except ValueError as error:
        raise InputError(str(error)) from None
    return Wavefront(image, parameters).per_step()
