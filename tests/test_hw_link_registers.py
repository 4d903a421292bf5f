"""The link's own registers, accessed over the link: counters and watchdog."""

import numpy as np
from integer_objects import random_image
from link_objects import KEY
from linked import ITEMS, QUIET, SMALL, Line
from test_hw_link_device import access, control, hello, loaded, read, write

from hw.link.frame import Frame
from hw.link.protocol import Operation, Status
from hw.link.registers import LINK, LINK_TEXT, Link
from hw.map.control import Control
from hw.map.memory_map import join
from sim.backends.native import NativeMachine

ALL = read(join(LINK, 0, 0, 0), len(Link))


def register(link):
    return join(LINK, 0, link, 0)


def counted(answer) -> dict[str, int]:
    """Return the counters that are not 0, except good frames."""
    values = dict(zip(Link, ITEMS.split(answer.payload)[1:], strict=True))
    return {link.name: value for link, value in values.items() if value and link != Link.GOOD_FRAMES}


def test_every_register_has_a_text():
    assert set(LINK_TEXT) == set(Link)


def test_the_fates_of_frames_are_counted():
    line = Line()
    packed = access(1, read(control(Control.MAGIC))).packed(KEY)
    line.exchange(hello())
    bad = bytearray(packed)
    bad[-2] ^= 1
    damage = {"CRC_ERRORS": 1, "COBS_ERRORS": 1, "LENGTH_ERRORS": 1}
    for damaged in (bytes(bad), b"\0\x05\x01\0", packed[:8] + b"\0"):
        line.send(damaged, QUIET)
    line.exchange(access(1, ALL), access(3, ALL), access(1, ALL))
    *_, answer = line.exchange(access(2, ALL))
    assert counted(answer) == {**damage, "GAPS": 1, "DUPLICATES": 1}
    assert ITEMS.split(answer.payload)[1 + Link.GOOD_FRAMES] == 5
    wrote, after = line.exchange(access(3, write(register(Link.GAPS), 1)), access(4, ALL))
    line.close()
    assert wrote.status == Status.DONE and counted(after) == {**damage, "DUPLICATES": 1}


def test_an_address_without_a_register_and_a_value_that_is_too_long_are_refused():
    line = Line()
    _, beyond, large, after = line.exchange(
        hello(),
        access(1, read(register(len(Link)))),
        access(2, write(register(Link.WATCHDOG), 1 << 32)),
        access(3, ALL),
    )
    line.close()
    assert (beyond.status, large.status) == (Status.REFUSED, Status.REFUSED) and not counted(after)
    assert ITEMS.split(beyond.payload) == [0, 0]


def test_a_malformed_greeting_begins_no_session():
    line = Line()
    wrong, stranger = line.exchange(Frame(Operation.HELLO, 4), access(5, read(control(Control.MAGIC))))
    line.close()
    assert (wrong.status, stranger.status) == (Status.MALFORMED, Status.STRANGER)


def test_a_segment_that_is_too_long_wraps_within_its_field():
    """After word 31 of index 5 comes its word 0, not word 0 of the next lane."""
    line = Line()
    address = join(1, 30, 5, 0)
    _, wrote, got = line.exchange(
        hello(), access(1, write(address, 11, 12, 13, across=True)), access(2, read(join(1, 0, 5, 0)))
    )
    line.close()
    assert wrote.status == Status.REFUSED and ITEMS.split(got.payload) == [0, 13]


def run_of(rng, steps, silence):
    """Return (line, first free seq, model) after a run was begun, with a watchdog of so many cycles."""
    image, line = random_image(rng, nodes=12, edges=16, materials=2, tables=1), Line()
    commands = list(loaded(image))
    line.exchange(*commands)
    begin = access(len(commands), write(register(Link.WATCHDOG), silence), write(control(Control.RUN), steps))
    line.send(begin.packed(KEY), 0)
    return line, len(commands) + 1, NativeMachine(image)


def test_a_run_ends_when_the_host_is_silent(rng):
    steps, silence = 1000, 20_000
    line, seq, model = run_of(rng, steps, silence)
    line.send(b"", 3 * silence)
    names = [read(join(1, word, 0, 0), len(model.x)) for word in range(3)]
    (answer,) = line.exchange(
        access(
            seq,
            read(control(Control.BUSY)),
            read(control(Control.STEPS_DONE)),
            read(control(Control.CYCLES)),
            read(register(Link.HALTS)),
            *names,
        )
    )
    line.close()
    busy, done, cycles, halts, *x = ITEMS.split(answer.payload)[1:]
    assert not busy and halts == 1 and 0 < done < steps
    assert silence < cycles < silence + 2 * cycles // done
    model.step(done)
    top = 1 << SMALL.formats.state - 1
    assert np.array_equal(((np.array(x).reshape(3, -1) ^ top) - top).T, model.x)


def test_a_run_goes_on_while_frames_come(rng):
    line, seq, _ = run_of(rng, 1000, 20_000)
    for number in range(10):
        line.send(access(seq + number, read(control(Control.BUSY))).packed(KEY), 12_000)
    (answer,) = line.exchange(access(seq + 10, read(control(Control.BUSY)), read(register(Link.HALTS))))
    line.close()
    assert ITEMS.split(answer.payload)[1:] == [1, 0]
