"""Commands over a line that loses and damages bytes: each is done exactly once, in order."""

import pytest
from served import ITEMS, SMALL, NoisyLine, serial_circuit

from hw.link.description import key
from hw.link.protocol import Kind, Operation, Status
from hw.map.control import MAGIC, Control
from hw.map.memory_map import Map, Region
from sim.backends.link.errors import NoAnswer
from sim.backends.link.session import Session

RATES = 1e-4, 1e-3, 1e-2, 5e-2
TIMEOUT = 20_000 / 24e6  # s: a window of short commands and their answers


def control(register):
    return Map(SMALL).address(Region.CONTROL, 0, register)


# A refused write counts one; then the count is read
REFUSED = ITEMS.head(Kind.WRITE, control(Control.MAGIC), 1) + ITEMS.pack(0)
COUNTING = REFUSED + ITEMS.head(Kind.READ, control(Control.REFUSED), 1)


def counted(rng, share, commands):
    """Return (the count that each command read, retries, damaged bytes)."""
    circuit = serial_circuit()
    line = NoisyLine(circuit, rng, share)
    session = Session(line, lambda identity: key(SMALL), TIMEOUT, attempts=1000, clock=line.clock)
    answers = list(session.commands([(Operation.ACCESS, COUNTING)] * commands))
    circuit.close()
    assert all(answer.status == Status.REFUSED for answer in answers)
    return [ITEMS.split(answer.payload)[1] for answer in answers], session.retries, line.damaged


def test_every_command_is_done_exactly_once_and_in_order(rng):
    counts, retries, damaged = counted(rng, 1e-3, 300)
    assert counts == list(range(1, 301))
    assert retries and damaged


@pytest.mark.campaign
@pytest.mark.parametrize("share", RATES)
def test_no_command_of_5000_is_lost_or_doubled(share, rng, figure):
    counts, retries, damaged = counted(rng, share, 5000)
    print(f"byte error rate {share:g}: {damaged} bytes damaged, {retries} times sent again")
    wrong = sum(count != number for number, count in enumerate(counts, 1))
    figure(f"commands lost or doubled, of 5,000 at a byte error rate of {share:g}", 0, wrong)
    assert counts == list(range(1, 5001)) and damaged


@pytest.mark.parametrize("error", [-0.02, 0.02])
def test_a_rate_error_of_two_per_cent_is_tolerated(error, rng):
    circuit = serial_circuit(host_error=error)
    line = NoisyLine(circuit, rng, 0)
    session = Session(line, lambda identity: key(SMALL), 10 * TIMEOUT, clock=line.clock)
    words = [int(w) for w in rng.integers(0, 1 << 36, 90)]
    x = Map(SMALL).address(Region.NODE, "x_x", 0)
    payload = ITEMS.head(Kind.WRITE, x, 30) + b"".join(map(ITEMS.pack, words[:30])) + ITEMS.head(Kind.READ, x, 30)
    answers = list(session.commands([(Operation.ACCESS, payload)] * 5))
    circuit.close()
    assert [ITEMS.split(answer.payload)[1:] for answer in answers] == [words[:30]] * 5 and not session.retries


@pytest.mark.parametrize("error", [-0.5, 1.0])
def test_a_host_with_another_rate_gets_no_answer(error, rng):
    circuit = serial_circuit(host_error=error)
    line = NoisyLine(circuit, rng, 0)
    with pytest.raises(NoAnswer, match="that --baud is the rate it was built for"):
        Session(line, lambda identity: key(SMALL), TIMEOUT, clock=line.clock)
    circuit.close()


def test_a_silent_line_is_an_error(rng):
    class Dead:
        url = "nowhere"

        def write(self, data):
            pass

        def read(self, seconds):
            return b""

    with pytest.raises(
        NoAnswer,
        match=r"--port must lead to a circuit that answers, but no answer came from nowhere within 0.06 s, "
        r"and 0 damaged frames: check that the board is loaded \(make flash\), that --port is its serial port, "
        "and that --baud is the rate it was built for",
    ):
        Session(Dead(), lambda identity: key(SMALL), timeout=0.01)


def test_a_new_session_begins_after_an_interrupted_one(rng):
    """The old one ends within a frame, with answers still under way."""
    circuit = serial_circuit()
    line = NoisyLine(circuit, rng, 0)
    for _ in range(10):
        session = Session(line, lambda identity: key(SMALL), TIMEOUT, clock=line.clock)
        assert session.identity.magic == MAGIC and session.identity.parameters() == SMALL
        answers = session.commands([(Operation.ACCESS, COUNTING)] * 20)
        for _ in range(int(rng.integers(1, 5))):
            next(answers)
        circuit.run(COUNTING[: int(rng.integers(len(COUNTING)))], int(rng.integers(2000)))
    circuit.close()
