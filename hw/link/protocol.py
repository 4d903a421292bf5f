"""The protocol of the link: one table for circuit, driver and documentation.

A payload is a list of items (`hw.link.items`), of as many bytes as a word of the circuit needs; the header of every
answer says how many. A command's payload is a list of segments; a segment is a head, and the words to write. An
answer's payload is the faults, then each word that was read and the CRC of each check.

A greeting comes before the host knows the size of an item. Its payload is `GREETING_BYTES`, a number in the lowest of
them and then zeros.
"""

from enum import IntEnum

from golden.numbers.qformat import BIT, unsigned
from golden.numbers.record import Record
from hw.link.frame import GREETING
from hw.link.send import ANSWERS
from hw.map.memory_map import ADDRESS

VERSION = 2
GREETING_BYTES = 8
"""Bytes of a greeting's payload, and the most that an item may have."""

WINDOW = ANSWERS
"""Commands that may be under way at once."""


class Operation(IntEnum):
    HELLO = GREETING
    ACCESS = 2
    EXCHANGE = 3


OPERATION_TEXT = {
    Operation.HELLO: "takes a number and gives it back, with the identity: begins a session; the next seq is one more",
    Operation.ACCESS: "does segments; while steps run, only words that may be accessed then",
    Operation.EXCHANGE: "does segments between two steps: a run pauses, and goes on afterwards to the same bits",
}


class Kind(IntEnum):
    """Kinds of segments."""

    READ = 0
    WRITE = 1
    CHECK = 2


KIND_TEXT = {
    Kind.READ: "gives the words",
    Kind.WRITE: "takes the words after it, gives nothing",
    Kind.CHECK: "gives the CRC-32 of the words' items",
}

HEAD = Record(
    {
        "address": unsigned(ADDRESS.width, 0),
        "across": BIT,
        "kind": unsigned(2, 0),
        "unused": unsigned(2, 0),
        "count": unsigned(8, 0),
    }
)
"""A segment's head. From a word to the next the index goes up, or, if ``across``, the number of the word."""

COUNT_MOST = HEAD["count"].raw_max


class Status(IntEnum):
    """The status of an answer, in the low four bits of its status byte."""

    DONE = 0
    REFUSED = 1
    UNKNOWN = 2
    MALFORMED = 3
    STRANGER = 4


STATUS_TEXT = {
    Status.DONE: "all was done",
    Status.REFUSED: "at least one word was refused; all others were done",
    Status.UNKNOWN: "no such operation: nothing was done",
    Status.MALFORMED: "the payload is not what the operation takes, or its answer too long: nothing was done",
    Status.STRANGER: "there is no session: nothing was done",
}

BUSY = 0x10
"""Bit of the status byte: a run is under way."""
