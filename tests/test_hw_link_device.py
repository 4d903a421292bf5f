"""Commands on a real circuit: each is done once and in order, or refused with a status."""

import itertools
import zlib

import numpy as np
import pytest
from integer_objects import random_image
from link_objects import KEY
from linked import IDENTITY, ITEMS, QUIET, SMALL, Line

from hw.link.frame import ANSWER, Frame
from hw.link.protocol import BUSY, GREETING_BYTES, Kind, Operation, Status
from hw.map.control import MAGIC, Control
from hw.map.memory_map import Map, Region
from sim.backends.native import NativeMachine
from sim.encode.program import Program


def exchanged(*commands: Frame) -> list[Frame]:
    """Return a new circuit's answers."""
    line = Line()
    answers = line.exchange(*commands)
    line.close()
    return answers


def hello(seq=0, nonce=7):
    return Frame(Operation.HELLO, seq, payload=nonce.to_bytes(GREETING_BYTES, "little"))


def control(register):
    return Map(SMALL).address(Region.CONTROL, 0, register)


def read(address, count=1, across=False):
    return ITEMS.head(Kind.READ, address, count, across)


def write(address, *words, across=False):
    return ITEMS.head(Kind.WRITE, address, len(words), across) + b"".join(map(ITEMS.pack, words))


def check(address, count):
    return ITEMS.head(Kind.CHECK, address, count)


def access(seq, *segments, operation=Operation.ACCESS):
    return Frame(operation, seq, payload=b"".join(segments))


def test_a_greeting_is_answered_with_the_identity():
    (answer,) = exchanged(hello(9, nonce=0xABCDE))
    payload = b"".join(map(ITEMS.pack, (0, 0xABCDE, *IDENTITY)))
    assert answer == Frame(Operation.HELLO | ANSWER, 9, Status.DONE, payload, ITEMS.bytes)


def test_written_words_are_read_and_checked(rng):
    words = [int(w) for w in rng.integers(0, 1 << 36, 12)]
    x, v = (Map(SMALL).address(Region.NODE, name, 3) for name in ("x_x", "v_x"))
    _, wrote, got = exchanged(
        hello(),
        access(1, write(x, *words[:6], across=True), write(x + 1, *words[6:])),
        access(2, read(v, 3, across=True), read(x + 1, 6), check(x + 1, 6), read(control(Control.MAGIC))),
    )
    assert wrote == Frame(Operation.ACCESS | ANSWER, 1, Status.DONE, ITEMS.pack(0), ITEMS.bytes)
    crc = zlib.crc32(b"".join(map(ITEMS.pack, words[6:])))
    assert ITEMS.split(got.payload) == [0, *words[3:6], *words[6:], crc, MAGIC]
    assert (got.seq, got.status) == (2, Status.DONE)


def test_a_refused_word_is_reported_and_the_others_are_done():
    load = Map(SMALL).address(Region.NODE, "load_x", 0)
    _, wrote, got = exchanged(
        hello(),
        access(1, write(control(Control.MAGIC), 5), write(load, 8)),
        access(2, read(load), read(control(Control.REFUSED))),
    )
    assert (wrote.status, got.status, ITEMS.split(got.payload)) == (Status.REFUSED, Status.DONE, [0, 8, 1])


X = Map(SMALL).address(Region.NODE, "x_x", 0)


@pytest.mark.parametrize(
    ("frame", "status"),
    [
        (access(1, write(X, 5), read(X)[:-1]), Status.MALFORMED),
        (access(1, write(X, 5), write(X, 6, 7)[:-1]), Status.MALFORMED),
        (access(1, write(X, 5), write(X, 6, 7)[: -ITEMS.bytes]), Status.MALFORMED),
        (access(1, write(X, 5), ITEMS.head(3, X, 1)), Status.MALFORMED),
        (access(1, write(X, 5), read(X, 16), *[read(X, 14)] * 6, read(X, 1)), Status.MALFORMED),
        (access(1, write(X, 5), operation=9), Status.UNKNOWN),
    ],
)
def test_a_malformed_payload_does_nothing(frame, status):
    _, answer, after = exchanged(hello(), frame, access(2, read(X)))
    assert answer == Frame(frame.type | ANSWER, 1, status, ITEMS.pack(0), ITEMS.bytes)
    assert ITEMS.split(after.payload) == [0, 0]


def test_the_longest_answer_is_sent():
    _, answer = exchanged(hello(), access(1, read(X, 16), *[read(X, 14)] * 6))
    assert len(ITEMS.split(answer.payload)) == ITEMS.answer_most + 1 and answer.status == Status.DONE


def test_a_command_before_a_greeting_does_nothing():
    stranger, _, got = exchanged(access(0, write(X, 5)), hello(7), access(8, read(X)))
    assert stranger == Frame(Operation.ACCESS | ANSWER, 0, Status.STRANGER, ITEMS.pack(0), ITEMS.bytes)
    assert ITEMS.split(got.payload) == [0, 0]


def test_each_command_is_done_once_and_in_order():
    """A repeated command is answered again; one that comes too early is dropped."""
    add = [access(n, write(X, 10 + n), read(X)) for n in range(1, 4)]
    answers = exchanged(hello(), add[0], add[2], add[0], add[1], add[0], add[2], access(4, read(X)))
    seen = [(answer.seq, ITEMS.split(answer.payload)[1]) for answer in answers[1:]]
    assert seen == [(1, 11), (1, 11), (2, 12), (1, 11), (3, 13), (4, 13)]


def test_a_new_greeting_begins_a_new_session():
    answers = exchanged(hello(), access(1, write(X, 5)), hello(100), access(101, read(X)), access(2, read(X)))
    assert [a.seq for a in answers] == [0, 1, 100, 101] and ITEMS.split(answers[-1].payload) == [0, 5]


STEPS = 200


def loaded(image):
    """Yield a greeting, and the commands that load an image."""
    program = Program(image, SMALL)
    writes = itertools.chain(program.load(), program.start(image.v, image.x))
    yield hello()
    for seq in itertools.count(1):
        some = list(itertools.islice(writes, 50))
        if not some:
            return
        yield access(seq, *(write(address, word) for address, word in some))


def state(answer) -> tuple[np.ndarray, ...]:
    """Return the (N, 3) positions and forces in an answer."""
    words = np.array(ITEMS.split(answer.payload)[1:]).reshape(2, 3, -1)
    top = 1 << SMALL.formats.state - 1
    return tuple(((part ^ top) - top).T for part in words)


def test_exchanges_see_whole_steps_and_leave_the_run_as_it_is(rng):
    image = random_image(rng, nodes=12, edges=16, materials=2, tables=1)
    model, line = NativeMachine(image), Line()
    names = [f"{quantity}_{axis}" for quantity in ("x", "force") for axis in "xyz"]
    look = [read(Map(SMALL).address(Region.NODE, name), image.nodes) for name in names]
    commands = list(loaded(image))
    assert all(answer.status == Status.DONE for answer in line.exchange(*commands))
    seq = len(commands)
    (started,) = line.exchange(access(seq, write(control(Control.RUN), STEPS)))
    assert started.status & BUSY
    seen = []
    while not seen or seen[-1].status & BUSY:
        seq += 1
        seen += line.exchange(access(seq % 256, *look, operation=Operation.EXCHANGE))
    line.close()

    expected = []
    for _ in range(STEPS):
        model.step(1)
        expected.append((model.x.copy(), model.force.copy()))
    number = 0
    for answer in seen:
        x, force = state(answer)
        number = next(n for n in range(number, STEPS) if np.array_equal(expected[n][0], x))
        assert np.array_equal(expected[number][1], force)
    assert number == STEPS - 1 and len(seen) > 4


def test_a_run_that_ends_while_it_is_being_paused_is_over(rng):
    """The pause begins anywhere in the last steps; only the true number of steps done may count."""
    image, line = random_image(rng, nodes=12, edges=16, materials=2, tables=1), Line()
    commands = list(loaded(image))
    line.exchange(*commands)
    for seq, gap in enumerate(range(0, 1500, 8)):
        first = len(commands) + 2 * seq
        run = access(first % 256, write(control(Control.RUN), 3))
        look = access((first + 1) % 256, read(control(Control.STEPS_DONE)), operation=Operation.EXCHANGE)
        line.send(run.packed(KEY), gap)
        line.send(look.packed(KEY), 3 * QUIET)
    answers = line.exchange(access((first + 2) % 256, read(control(Control.BUSY))))
    line.close()
    assert ITEMS.split(answers[0].payload)[1] == 0
