"""Commands are answered within the stated number of cycles, and the bound has no cycle to spare."""

import pytest
from integer_objects import random_image
from link_objects import KEY
from linked import ITEMS, Line
from test_hw_link_device import X, access, check, control, hello, loaded, read, write

from hw.link.bound import PAUSED, cycles, longest
from hw.link.frame import PAYLOAD_MOST, unpacked
from hw.link.protocol import BUSY, COUNT_MOST, HEAD, Kind, Operation, Status
from hw.link.receive import BYTE_CYCLES
from hw.link.work import Work
from hw.map.control import Control

AFTER_LAST_ITEM = {Kind.READ: 3, Kind.CHECK: 2}
"""Cycles from a segment's last item to the payload's end. Meanwhile the item is written; the bound adds both up."""


def overlap(segments: list[bytes]) -> int:
    """Return the cycles by which the bound is larger than the time of a command."""
    head = HEAD.unpack(ITEMS.split(segments[-1])[0]) if segments else {"kind": Kind.WRITE, "count": 0}
    gives = head["count"] or head["kind"] == Kind.CHECK
    return AFTER_LAST_ITEM.get(head["kind"], ITEMS.bytes) if gives else ITEMS.bytes


def taken(line: Line, command, most: int) -> int:
    """Return the cycles from the frame's last byte to the answer's first, once the answer has ended."""
    began = line.send(command.packed(KEY), 0)
    waited = BYTE_CYCLES - 1
    while not began and waited <= most:
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
    "one word checked": ([check(X, 1)], Work(1, checked=1, checks=1)),
    "no words": ([read(X, 0)] * 7, Work(7)),
    "as many words read as an answer holds": ([read(X, ITEMS.answer_most)], Work(1, read=ITEMS.answer_most)),
    "each for itself": ([read(X)] * ITEMS.answer_most, Work(ITEMS.answer_most, read=ITEMS.answer_most)),
    "as many written as a payload holds": ([write(X, *range(16), *range(85))], Work(1, written=101)),
    "long checks": ([check(X, COUNT_MOST)] * 3, Work(3, checked=3 * COUNT_MOST, checks=3)),
    "the longest": (
        [check(X, COUNT_MOST)] * ITEMS.answer_most + [read(X, 0)] * 2,
        Work(ITEMS.answer_most + 2, checked=ITEMS.answer_most * COUNT_MOST, checks=ITEMS.answer_most),
    ),
    "all of it": ([read(X, 5), write(X, 1, 2, 3), check(X, 9)] * 2, Work(6, 10, 6, 18, 2)),
}


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_takes_as_many_cycles_as_are_stated(name):
    segments, work = COMMANDS[name]
    line = Line()
    line.exchange(hello())
    bound = cycles(work, ITEMS)
    measured = taken(line, access(1, *segments), bound)
    line.close()
    print(f"{name}: {measured} cycles, at most {bound}")
    assert measured == bound - overlap(segments)


def test_an_exchange_waits_for_the_end_of_a_step_besides(rng):
    line = Line()
    commands = list(loaded(random_image(rng, nodes=12, edges=16, materials=2, tables=1)))
    line.exchange(*commands)
    seq, steps = len(commands), 400
    line.exchange(access(seq, write(control(Control.RUN), 10)))
    (counted,) = line.exchange(access(seq + 1, read(control(Control.CYCLES))))
    step = ITEMS.split(counted.payload)[1] / 10
    line.exchange(access(seq + 2, write(control(Control.RUN), steps)))
    one = cycles(Work(1, read=1), ITEMS)
    for number in range(5):
        look = access(seq + 3 + number, read(control(Control.BUSY)), operation=Operation.EXCHANGE)
        measured = taken(line, look, int(one + PAUSED + 2 * step))
        print(f"{measured} cycles, at most {one} + {PAUSED} and two steps of {step:g}")
        assert one < measured <= one + PAUSED + 2 * step
    line.close()


def test_no_payload_takes_longer_than_the_longest():
    """Each item of a payload is a head or a written word; a head gives words read, or a sum, or nothing."""
    fits, most = PAYLOAD_MOST // ITEMS.bytes, 0
    for heads in range(fits + 1):
        for checks in range(min(heads, ITEMS.answer_most) + 1):
            read = ITEMS.answer_most - checks if heads > checks else 0
            written = fits - heads if heads > checks else 0
            most = max(most, cycles(Work(heads, read, written, checks * COUNT_MOST, checks), ITEMS))
    assert most == longest(ITEMS)
