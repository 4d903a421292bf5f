"""Accesses as segments: every word at its address, in order, in payloads that the circuit takes."""

from integer_objects import random_image

from hw.link.frame import PAYLOAD_MOST
from hw.link.items import Items
from hw.link.protocol import HEAD, Kind
from hw.parameters import Parameters
from sim.backends.link import segments
from sim.encode.program import Program

ITEMS = Items.of_word(36)


def heads(payload):
    """Return (kind, [addresses], [words to write]) of each of a payload's segments."""
    rest = ITEMS.split(payload)
    while rest:
        field, rest = HEAD.unpack(rest[0]), rest[1:]
        stride = segments.STRIDES[bool(field["across"])]
        addresses = [field["address"] + n * stride for n in range(field["count"])]
        words = field["count"] if field["kind"] == Kind.WRITE else 0
        yield field["kind"], addresses, rest[:words]
        rest = rest[words:]


def pairs(rng):
    """Return the words that load an object, and single words anywhere."""
    image = random_image(rng, nodes=12, edges=16, materials=2, tables=1)
    program = Program(image, Parameters(lanes=2, nodes=16, edges=16, materials=2, tables=1))
    alone = [(int(a), int(w)) for a, w in zip(rng.integers(0, 1 << 20, 50), rng.integers(0, 1 << 36, 50), strict=True)]
    return [*program.load(), *alone, *program.start(image.v, image.x)]


def test_writes_keep_addresses_words_and_order(rng):
    wanted, got = pairs(rng), []
    payloads = list(segments.writes(wanted, ITEMS))
    for payload in payloads:
        assert len(payload) <= PAYLOAD_MOST and len(payload) % ITEMS.bytes == 0
        for kind, addresses, words in heads(payload):
            assert kind == Kind.WRITE
            got += zip(addresses, words, strict=True)
    assert got == wanted
    assert sum(map(len, payloads)) < 1.25 * ITEMS.bytes * len(wanted)


def test_reads_and_checks_reach_every_address_in_order(rng):
    wanted = [address for address, _ in pairs(rng)]
    got = []
    for payload in segments.reads(wanted, ITEMS):
        read = [addresses for kind, addresses, _ in heads(payload)]
        assert len(payload) <= PAYLOAD_MOST and sum(map(len, read)) <= ITEMS.answer_most
        got += [address for addresses in read for address in addresses]
    assert got == wanted
    got = []
    for payload, counts in segments.checks(wanted, ITEMS):
        checked = [(kind, addresses) for kind, addresses, _ in heads(payload)]
        assert len(payload) <= PAYLOAD_MOST and [len(addresses) for _, addresses in checked] == counts
        assert {kind for kind, _ in checked} == {Kind.CHECK}
        got += [address for _, addresses in checked for address in addresses]
    assert got == wanted


def test_a_long_run_is_cut_and_a_run_across_is_one_segment():
    assert list(segments.runs(range(600))) == [(0, 255, False), (255, 255, False), (510, 90, False)]
    addresses = [3 + (word << 16) for word in range(6)]
    assert list(segments.runs(addresses)) == [(3, 6, True)]
    assert list(segments.runs([])) == [] and not list(segments.writes([], ITEMS))
