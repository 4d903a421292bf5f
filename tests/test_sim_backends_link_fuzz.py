"""The driver under stress, against the whole circuit: whatever happens to line, circuit or session, reads give what was
written, every failure has its type, and a new session always works."""

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, precondition, rule, run_state_machine_as_test
from integer_objects import random_image
from served import SMALL, NoisyLine, serial_circuit

from hw.map.control import Control
from hw.map.memory_map import Map, Region
from sim.backends.circuit import CircuitMachine
from sim.backends.link.board import Board
from sim.backends.link.errors import CommandRefused, LinkError
from sim.backends.link.session import ATTEMPTS
from sim.backends.native import NativeMachine

TIMEOUT = 4e-3
"""Seconds of the circuit's time, more than a window of these commands and their answers takes."""
LONGEST = 40 * ATTEMPTS * TIMEOUT
"""Seconds of the circuit's time within which a command is done or fails; loading an object takes at most 30 windows."""
NODES = 20
MAP = Map(SMALL)
SPARE = [
    MAP.address(Region.NODE, name, node) for name in ("x_x", "v_y", "load_z") for node in range(NODES, SMALL.nodes)
]
WORDS = st.dictionaries(st.sampled_from(SPARE), st.integers(0, (1 << 36) - 1), min_size=1)


class Line(NoisyLine):
    """A line whose directions can each be cut."""

    cut = False

    def _damage(self, data):
        return b"" if self.cut else super()._damage(data)


class Driver(RuleBasedStateMachine):
    """``memory`` has the words that must be there, without those that a failed write may have changed."""

    @initialize(seed=st.integers(0, 1 << 32))
    def begin(self, seed):
        rng = np.random.default_rng(seed)
        self.circuit, self.memory, self.machine = serial_circuit(), {}, None
        self.line = Line(self.circuit, rng, 0)
        self.image = random_image(rng, nodes=NODES, edges=30, materials=2, tables=1)
        self.board = Board(self.line, TIMEOUT, self.line.clock)

    def attempt(self, action, *arguments):
        """Return (whether it was done, its result); after a failure the next command must begin a session."""
        began = self.line.clock()
        try:
            result = action(*arguments)
        except LinkError:
            self.give_up()
            return False, None
        finally:
            assert self.line.clock() - began < LONGEST
        return True, result

    def give_up(self):
        """A closed port still sends what it has, which lasts longer than a session if it was sent many times."""
        self.board, self.machine, until = None, None, self.line.clock() + LONGEST
        while not self.circuit.idle:
            assert self.line.clock() < until, "the circuit doesn't come to rest"
            self.circuit.run(b"", 2000)

    @precondition(lambda self: self.board)
    @rule(words=WORDS)
    def write(self, words):
        for address in words:
            self.memory.pop(address, None)
        if self.attempt(self.board.write, words.items())[0]:
            self.memory.update(words)

    @precondition(lambda self: self.board and self.memory)
    @rule()
    def read(self):
        done, words = self.attempt(self.board.read, list(self.memory))
        assert not done or words.tolist() == list(self.memory.values())

    @precondition(lambda self: self.board and self.memory)
    @rule()
    def verify(self):
        self.attempt(self.board.verify, self.memory.items())

    @precondition(lambda self: self.board)
    @rule()
    def ask_for_what_is_refused(self):
        try:
            self.board.write([(MAP.address(Region.CONTROL, 0, Control.MAGIC), 1)])
        except CommandRefused:
            return
        except LinkError:
            self.give_up()
            return
        raise AssertionError("a register that can't be written was")

    @precondition(lambda self: self.board and not self.machine)
    @rule()
    def load(self):
        done, machine = self.attempt(CircuitMachine, self.image, self.board)
        if done:
            self.machine, self.model = machine, NativeMachine(self.image)

    @precondition(lambda self: self.board and self.machine)
    @rule(steps=st.integers(1, 20))
    def run(self, steps):
        def all_of_it():
            self.machine.step(steps)
            return self.machine.x, self.machine.v

        machine, (done, seen) = self.machine, self.attempt(all_of_it)
        if done:
            self.model.step(steps)
            assert machine is self.machine
            for found, expected in zip(seen, (self.model.x, self.model.v), strict=True):
                assert np.array_equal(found, expected)

    @rule(share=st.sampled_from([0, 1e-3, 1e-2, 5e-2]))
    def make_noise(self, share):
        self.line.share = share

    @rule(data=st.binary(min_size=1, max_size=60))
    def say_something_else(self, data):
        self.circuit.run(data, 200)

    @rule()
    def cut_the_line(self):
        self.line.cut = not self.line.cut

    @rule()
    def reset(self):
        self.circuit.reset()

    @rule()
    def begin_a_session(self):
        self.machine = None
        _, self.board = self.attempt(Board, self.line, TIMEOUT, self.line.clock)

    def teardown(self):
        self.line.share, self.line.cut = 0, False
        board = Board(self.line, TIMEOUT, self.line.clock)
        if self.memory:
            assert board.read(list(self.memory)).tolist() == list(self.memory.values())
        self.circuit.close()


def fuzzed(examples: int, steps: int):
    run_state_machine_as_test(
        Driver,
        settings=settings(max_examples=examples, stateful_step_count=steps, suppress_health_check=list(HealthCheck)),
    )


def test_the_driver_ends_with_the_right_state_or_a_typed_error():
    fuzzed(2, 12)


@pytest.mark.campaign
def test_a_long_fuzzing_campaign(figure):
    fuzzed(150, 40)
    figure("hangs, wrong states and errors without a type of a fuzzed driver, in 150 examples of 40 steps", 0, 0)
