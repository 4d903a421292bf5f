"""Pack accesses to many words into as few segments and payloads as possible."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from hw.link.frame import PAYLOAD_MOST
from hw.link.items import Items
from hw.link.protocol import COUNT_MOST, Kind
from hw.map.memory_map import ADDRESS

STRIDES = {False: 1, True: 1 << ADDRESS.offsets["word"]}
"""Steps from a word's address to the next: the next index, or, across, the next word of the same index."""


def runs(addresses: Iterable[int], most: int = COUNT_MOST) -> Iterator[tuple[int, int, bool]]:
    """Yield (address, count, across) of segments that access the addresses in order."""
    begin, count, across = None, 0, False
    for address in addresses:
        if count == 1 and address - begin in STRIDES.values():
            across, count = address - begin == STRIDES[True], 2
        elif 1 < count < most and address - begin == count * STRIDES[across]:
            count += 1
        else:
            if count:
                yield begin, count, across
            begin, count, across = address, 1, False
    if count:
        yield begin, count, across


def writes(pairs: list[tuple[int, int]], items: Items) -> Iterator[bytes]:
    """Yield payloads that write (address, word) pairs in order."""
    words, payload = iter(word for _, word in pairs), b""
    for begin, count, across in runs(address for address, _ in pairs):
        while count:
            room = (PAYLOAD_MOST - len(payload)) // items.bytes - 1
            if room < 1:
                yield payload
                payload, room = b"", items.command_most - 1
            some = min(room, count)
            payload += items.head(Kind.WRITE, begin, some, across)
            payload += b"".join(items.pack(next(words)) for _ in range(some))
            begin, count = begin + some * STRIDES[across], count - some
    if payload:
        yield payload


def reads(addresses: list[int], items: Items) -> Iterator[bytes]:
    """Yield payloads that read the words at these addresses in order."""
    payload, given = b"", 0
    for begin, count, across in runs(addresses):
        while count:
            some = min(count, items.answer_most - given)
            if some < 1 or len(payload) + items.bytes > PAYLOAD_MOST:
                yield payload
                payload, given = b"", 0
                continue
            payload += items.head(Kind.READ, begin, some, across)
            begin, count, given = begin + some * STRIDES[across], count - some, given + some
    if payload:
        yield payload


def checks(addresses: list[int], items: Items) -> Iterator[tuple[bytes, list[int]]]:
    """Yield (payload, number of words of each of its checks)."""
    payload, counts = b"", []
    for begin, count, across in runs(addresses):
        if len(payload) + items.bytes > PAYLOAD_MOST or len(counts) == items.answer_most:
            yield payload, counts
            payload, counts = b"", []
        payload += items.head(Kind.CHECK, begin, count, across)
        counts.append(count)
    if payload:
        yield payload, counts
