"""Resets at any time: within a received frame, an answer or a run. The next session's commands work."""

import itertools
from math import inf

import pytest
from served import CLOCK_HZ, SMALL, NoisyLine, serial_circuit

from hw.map.control import Control
from hw.map.memory_map import Map, Region
from sim.backends.link.board import Board

TIMEOUT = 2e-3
"""Seconds of the circuit's time, more than a window of these commands and their answers takes."""
WITHIN = 60_000
"""Cycles within which the reset comes; commands and answers are on the line meanwhile."""


class Reset(Exception):
    pass


class Line(NoisyLine):
    """Reset the circuit in cycle ``at``, whatever is on the line, and record it."""

    at = inf

    def read(self, seconds):
        left = self.at - self._circuit.clock
        if left > self.SLICE:
            return super().read(min(seconds, (left - self.SLICE) / CLOCK_HZ))
        data, self._waiting, self.at = self._waiting, b"", inf
        self._circuit.run(data, left)
        self._circuit.reset()
        raise Reset


def resets(rng, count) -> int:
    """Return the number of resets after which the next commands failed. Every third reset is within a run."""
    circuit, failed = serial_circuit(), 0
    line, memory = Line(circuit, rng, 0), Map(SMALL)
    addresses = [memory.address(Region.NODE, name, node) for name in ("x_x", "v_y") for node in range(SMALL.nodes)]
    control = {register: memory.address(Region.CONTROL, 0, register) for register in Control}
    run = [(control[Control.ROW_COUNT], 4), (control[Control.NODE_COUNT], 4), (control[Control.RUN], 1_000_000)]
    for number in range(count):
        board = Board(line, TIMEOUT, line.clock)
        words = [int(word) for word in rng.integers(0, 1 << 36, len(addresses))]
        board.write(zip(addresses, words, strict=True))
        failed += board.read(addresses).tolist() != words
        line.at = circuit.clock + int(rng.integers(1, WITHIN))
        with pytest.raises(Reset):
            board.write(run * (number % 3 == 0))
            for access in itertools.count():
                if number % 3 == 0:
                    board.read(list(control.values()))
                elif access % 2:
                    board.write([(address, access) for address in addresses])
                else:
                    board.read(addresses)
    circuit.close()
    return failed


def test_after_a_reset_anywhere_the_next_commands_work(rng):
    assert resets(rng, 12) == 0


@pytest.mark.campaign
def test_after_500_resets_anywhere_the_next_commands_work(rng, figure):
    failed = resets(rng, 500)
    figure("resets anywhere in a frame, an answer or a run after which the next commands don't work, of 500", 0, failed)
    assert failed == 0
