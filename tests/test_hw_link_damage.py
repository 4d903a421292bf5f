"""Damaged frames: the circuit applies none, counts each by its kind, and accepts the next good frame. The host's
decoder (cobs, zlib) tells which are still frames."""

import random
from collections import Counter

import pytest
from link_objects import KEY
from linked import ITEMS, Line
from test_hw_link_device import X, access, hello, read, write

from hw.link.bound import cycles
from hw.link.frame import LEAST, FrameError, unpacked
from hw.link.interfaces import EVENTS
from hw.link.protocol import Status
from hw.link.registers import LINK, Link
from hw.link.send import LOOK
from hw.link.work import Work
from hw.map.memory_map import join

MILLION = 1_000_000
NEXT_GOOD = 8
"""Most damaged frames before a good one."""
COUNTERS = [Link[event.upper()] for event in EVENTS]
WORDS = 3
"""Number of words that are read, and that the damaged frames would write."""
COUNTED_EVERY = 20
"""Good frames from one that reads the counters to the next."""


def flips(r, frame, _):
    changed = bytearray(frame)
    for _ in range(r.randint(1, 4)):
        changed[r.randrange(len(frame))] ^= 1 << r.randrange(8)
    return changed


def drops(r, frame, _):
    return bytes(byte for n, byte in enumerate(frame) if n not in {r.randrange(len(frame)) for _ in range(2)})


def inserts(r, frame, _):
    at = r.randrange(len(frame) + 1)
    return frame[:at] + r.randbytes(r.randint(1, 3)) + frame[at:]


def bursts(r, frame, _):
    at = r.randrange(len(frame))
    length = r.randint(2, 8)
    return frame[:at] + r.randbytes(len(frame[at : at + length])) + frame[at + length :]


def truncations(r, frame, _):
    return frame[: r.randrange(len(frame))] if r.random() < 0.5 else frame[r.randrange(1, len(frame)) :]


def splices(r, frame, other):
    return frame[: r.randrange(1, len(frame))] + other[r.randrange(1, len(other)) :]


def noise(r, frame, _):
    return r.randbytes(r.randint(1, 2 * len(frame)))


KINDS = flips, drops, inserts, bursts, truncations, splices, noise


def damaged(r, seq):
    """Return (a write command that was damaged until it is no frame, with a zero; the events to count)."""
    frame, other = (
        access(seq, *(write(X + n, r.getrandbits(36) | 1) for n in range(r.randint(1, WORDS)))).packed(KEY)
        for _ in range(2)
    )
    while True:
        bad = bytes(r.choice(KINDS)(r, frame, other)) + b"\0"
        counted = [event_of(part) for part in bad.split(b"\0") if part]
        if "good_frames" not in counted:  # else a zero was lost or added, or two halves fit together
            return bad, counted


def answered(words: int) -> int:
    """Return the cycles until an answer is sent; each byte is read twice more, and COBS adds some."""
    work = Work(segments=2, read=words)
    return cycles(work, ITEMS) + 3 * LOOK * (LEAST + ITEMS.bytes * work.items)


def event_of(coded: bytes) -> str:
    """Return the event that the circuit has to count for the bytes between two zeros."""
    try:
        unpacked(coded, KEY)
    except FrameError as error:
        return error.kind
    return "good_frames"


def campaign(seed: int, frames: int) -> Counter:
    """Return how often each event was counted for so many damaged frames, after checking every good answer."""
    r, line, expected = random.Random(seed), Line(), Counter({"good_frames": 1})
    words, counters = read(X, WORDS), read(join(LINK, 0, COUNTERS[0], 0), len(COUNTERS))
    line.exchange(hello(0))
    number = 0
    while number < frames:
        seq = expected["good_frames"] % 256
        counts = expected["good_frames"] % COUNTED_EVERY == 0
        sent = b""
        for _ in range(min(r.randint(1, NEXT_GOOD), frames - number)):
            bad, kinds = damaged(r, seq)
            sent += bad
            expected.update(kinds)
            number += 1
        good = access(seq, words, *[counters] * counts)
        expected["good_frames"] += 1
        came = line.send(sent + good.packed(KEY), answered(WORDS + len(COUNTERS) * counts))
        answer = unpacked(came.strip(b"\0"), KEY)
        assert (answer.seq, answer.status) == (seq, Status.DONE), f"after {number} frames: {answer}"
        _, *x = ITEMS.split(answer.payload)
        about = f"after {number} frames, of which the last were {sent.hex()}"
        assert not any(x[:WORDS]), f"{about}, words are {x[:WORDS]}"
        counted = dict(zip(EVENTS, x[WORDS:], strict=counts))
        assert not counts or Counter(counted) == expected, f"{about}: {counted}"
    line.close()
    return expected


def test_nothing_of_a_damaged_frame_is_applied_and_the_next_good_one_is(seed):
    seen = campaign(seed, 1000)
    print(dict(seen))
    assert min(seen[kind] for kind in ("cobs_errors", "length_errors", "crc_errors")) > 20


@pytest.mark.campaign
def test_nothing_of_a_million_damaged_frames_is_applied(seed, figure):
    seen = campaign(seed + 1, MILLION)
    print(dict(seen))
    figure(f"damaged frames applied, of {MILLION:,}, each group followed by a good one that is", 0, 0)
