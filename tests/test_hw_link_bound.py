"""Commands are answered within the documented number of cycles, and it isn't a number that anything would keep."""

import pytest
from integer_objects import random_image
from link_objects import KEY
from linked import Line
from test_hw_link_device import X, access, control, hello, loaded, read, write

from hw.link.bound import LONGEST, PAUSED, Work, cycles
from hw.link.frame import PAYLOAD_MOST, unpacked
from hw.link.protocol import BUSY, COUNT_MOST, ITEM_BYTES, ITEMS_MOST, Kind, Operation, Status, head, items
from hw.link.receive import BYTE_CYCLES
from hw.map.control import Control

SLACK = ITEM_BYTES
"""Cycles that the bound may be more than what is taken: those in which the last item is written."""


def taken(line: Line, command, most: int) -> int:
    """Cycles from the frame's last byte to the answer's first; the answer is awaited to its end."""
    began = line.send(command.packed(KEY), 0)
    waited = BYTE_CYCLES - 1
    while not began and waited <= most + SLACK:
        began = line.send(b"", 1)
        waited += 1
    while more := line.send(b"", 5000):
        began += more
    answer = unpacked(began.strip(b"\0"), KEY)
    assert answer.seq == command.seq and answer.status & ~BUSY in (Status.DONE, Status.REFUSED)
    return waited


COMMANDS = {
    "nothing": ([], Work(0)),
    "one word read": ([read(X)], Work(1, read=1)),
    "one word written": ([write(X, 1)], Work(1, written=1)),
    "one word checked": ([head(Kind.CHECK, X, 1)], Work(1, checked=1, checks=1)),
    "no words": ([read(X, 0)] * 7, Work(7)),
    "as many words read as an answer holds": ([read(X, ITEMS_MOST)], Work(1, read=ITEMS_MOST)),
    "each for itself": ([read(X)] * ITEMS_MOST, Work(ITEMS_MOST, read=ITEMS_MOST)),
    "as many written as a payload holds": ([write(X, *range(16), *range(85))], Work(1, written=101)),
    "long checks": ([head(Kind.CHECK, X, COUNT_MOST)] * 3, Work(3, checked=3 * COUNT_MOST, checks=3)),
    "the longest": (
        [head(Kind.CHECK, X, COUNT_MOST)] * ITEMS_MOST + [read(X, 0)] * 2,
        Work(ITEMS_MOST + 2, checked=ITEMS_MOST * COUNT_MOST, checks=ITEMS_MOST),
    ),
    "all of it": ([read(X, 5), write(X, 1, 2, 3), head(Kind.CHECK, X, 9)] * 2, Work(6, 10, 6, 18, 2)),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_is_answered_within_its_cycles(name):
    segments, work = COMMANDS[name]
    line = Line()
    line.exchange(hello())
    measured = taken(line, access(1, *segments), cycles(work))
    line.close()
    print(f"{name}: {measured} cycles, at most {cycles(work)}")
    assert cycles(work) - SLACK <= measured <= cycles(work)


def test_an_exchange_waits_for_the_end_of_a_step_besides(rng):
    line = Line()
    commands = list(loaded(random_image(rng, nodes=12, edges=16, materials=2, tables=1)))
    line.exchange(*commands)
    seq, steps = len(commands), 400
    line.exchange(access(seq, write(control(Control.RUN), 10)))
    (counted,) = line.exchange(access(seq + 1, read(control(Control.CYCLES))))
    step = items(counted.payload)[1] / 10
    line.exchange(access(seq + 2, write(control(Control.RUN), steps)))
    one = cycles(Work(1, read=1))
    for number in range(5):
        look = access(seq + 3 + number, read(control(Control.BUSY)), operation=Operation.EXCHANGE)
        measured = taken(line, look, int(one + PAUSED + 2 * step))
        print(f"{measured} cycles, at most {one} + {PAUSED} and two steps of {step:g}")
        assert one < measured <= one + PAUSED + 2 * step
    line.close()


def test_no_payload_takes_longer_than_the_longest():
    """Each item of a payload is a head or a written word; a head gives words read, or a sum, or nothing."""
    fits, longest = PAYLOAD_MOST // ITEM_BYTES, 0
    for heads in range(fits + 1):
        for checks in range(min(heads, ITEMS_MOST) + 1):
            read = ITEMS_MOST - checks if heads > checks else 0
            written = fits - heads if heads > checks else 0
            longest = max(longest, cycles(Work(heads, read, written, checks * COUNT_MOST, checks)))
    assert longest == LONGEST
