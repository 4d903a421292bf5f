"""Live access to an object that runs: values of whole steps, velocities from a step on, and the stated bytes."""

import re
from pathlib import Path

import numpy as np
import pytest
import scene_text
from served import ITEMS, SMALL, NoisyLine, serial_circuit, served

from golden.scene import load as scenes
from golden.support.errors import InputError
from hw.link import bound
from hw.link.description import key
from hw.link.frame import Frame
from hw.link.protocol import Operation
from hw.link.send import LOOK
from hw.map.control import Control
from hw.map.memory_map import Map, Region
from sim.backends.circuit import CircuitMachine
from sim.backends.link.board import Board
from sim.backends.link.live import Live, line_bytes, most_nodes
from sim.backends.link.session import Session
from sim.backends.native import NativeMachine
from sim.encode.encode import encode
from sim.encode.order import ranks


@pytest.fixture
def loaded(tmp_path):
    text = scene_text.changed(scene_text.SCENE, "duration = 0.01\n", "duration = 10.0\n")
    text = scene_text.changed(text, "every = 30", "every = 50000")
    text = scene_text.changed(text, "velocity = [0, -0.5]", "velocity = [0, -0.001]")
    return encode(scenes.load(scene_text.written(tmp_path, text)))


class Named:
    """The attributes of a board that are needed without a line."""

    parameters = SMALL


def driven(loaded):
    return np.flatnonzero(loaded.scene.phases[0].driven)


def test_an_exchange_sees_one_step_and_sets_the_velocity(loaded):
    """The integer model, with the same velocities after the same steps, has all the states that were seen."""
    nodes, model = driven(loaded), NativeMachine(loaded.image)
    rank = ranks(loaded.node_order)[nodes]
    with served() as service:
        board = Board.at(service.url)
        live = Live(board, loaded, nodes)
        CircuitMachine(loaded.image, board)
        board.write([(Map(SMALL).address(Region.CONTROL, 0, Control.RUN), 100_000)])
        seen = []
        for speed in (0.0, 0.002, -0.001, 0.0):
            velocity = np.full((len(nodes), 2), [0, speed])
            seen.append((velocity, *live.exchange(velocity)))
        assert board.run()
        board.close()
    done = 0
    for number, (velocity, x, force) in enumerate(seen):
        for _ in range(100_000):
            if (
                done
                and np.array_equal(loaded.positions(model.x)[nodes], x)
                and np.array_equal(loaded.forces(model.force)[nodes], force)
            ):
                break
            model.step(1)
            done += 1
        else:
            raise AssertionError(f"no step shows what exchange {number} saw")
        v = model.v.copy()
        v[rank, 1] = np.round(velocity[:, 1] / loaded.units.velocity * 2**loaded.image.formats.velocity.frac_bits)
        model.restart(v)
    assert done > 20


def test_an_exchange_takes_the_stated_bytes(loaded):
    circuit, lengths = serial_circuit(), []

    class Line(NoisyLine):
        def write(self, data):
            lengths.append(len(data))
            super().write(data)

        def read(self, seconds):
            data = super().read(seconds)
            lengths.append(len(data))
            return data

    line = Line(circuit, None, 0)
    line._damage = lambda data: data
    session = Session(line, lambda identity: key(SMALL), 0.01, clock=line.clock)
    nodes = driven(loaded)[:2]
    live = Live(Named(), loaded, nodes)
    lengths.clear()
    before = circuit.clock
    (answer,) = session.commands([(Operation.EXCHANGE, live.payload(np.zeros((2, 2))))])
    cycles = circuit.clock - before
    circuit.close()
    there, back = line_bytes(2, ITEMS)
    assert lengths[0] == there and len(Frame(1, 1, payload=answer.payload).packed(b"")) == back
    on_the_line = 10 * circuit.linked.identity.bit_cycles * (there + back)
    between = bound.cycles(bound.Work(segments=6, read=12, written=6), ITEMS) + bound.PAUSED + LOOK * back
    assert on_the_line < cycles + line.SLICE < on_the_line + between + 2 * line.SLICE  # the machine was not running


def test_more_nodes_than_fit_are_refused(loaded):
    board = Named()
    with pytest.raises(InputError, match=f"nodes must be 1 to {most_nodes(ITEMS)}, which fit one exchange, not 30"):
        Live(board, loaded, np.zeros(30, int))
    with pytest.raises(InputError, match="not 0"):
        Live(board, loaded, np.zeros(0, int))


def test_the_page_states_the_time_of_an_exchange():
    page = Path(__file__).parents[1].joinpath("docs", "link.md").read_text()
    (one, other) = (line_bytes(nodes, ITEMS) for nodes in (1, 9))
    text = re.sub(r"\s+", " ", page)
    times = [10 * sum(count) / baud for baud in (1e3, 3e3) for count in (one, other)]  # ms, ten bits a byte
    assert (
        f"For one node {one[0]} bytes go out and {one[1]} come back, {times[0]:.2f} ms on the line at 1 Mbaud and "
        f"{times[2]:.2f} ms at 3; for nine nodes {other[0]} and {other[1]}, {times[1]:.1f} and {times[3]:.1f} ms."
    ) in text
    assert f"up to {most_nodes(ITEMS)} nodes" in text
