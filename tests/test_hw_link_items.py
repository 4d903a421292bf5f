"""Items hold the words of any circuit: they have as many bytes as a word needs, and no bit is lost."""

import pytest
from hw_objects import refused
from hypothesis import given
from hypothesis import strategies as st
from link_objects import KEY

from hw.link.device import Device
from hw.link.items import Items
from hw.link.protocol import HEAD, Kind


@pytest.mark.parametrize(("state", "size"), [(34, 5), (36, 5), (40, 5), (41, 6), (44, 6), (48, 6), (64, 8)])
def test_an_item_has_the_bytes_that_a_word_needs(state, size):
    assert Items.of_word(state).bytes == size


@given(st.integers(34, 64), st.data())
def test_words_come_back(state, data):
    items = Items.of_word(state)
    words = data.draw(st.lists(st.integers(0, (1 << state) - 1), max_size=9))
    assert items.split(b"".join(map(items.pack, words))) == words


@pytest.mark.parametrize("size", range(5, 9))
def test_a_head_is_an_item(size):
    items = Items(size)
    (word,) = items.split(items.head(Kind.CHECK, 0x1234567, 255, across=True))
    assert HEAD.unpack(word) == {"address": 0x1234567, "across": 1, "kind": Kind.CHECK, "unused": 0, "count": 255}


def test_a_word_that_is_too_long_is_refused():
    refused(lambda: Items(5).pack(1 << 40), "a word must fit an item of 40 bits, not be 0x10000000000")
    refused(lambda: Items(5).pack(-1), "a word must fit an item of 40 bits, not be -0x1")


@pytest.mark.parametrize("size", [0, 4, 9])
def test_an_item_holds_a_head_and_fits_a_greeting(size):
    refused(lambda: Items(size), f"an item must have 5 to 8 bytes, not {size}")


def test_a_device_for_words_that_no_item_holds_is_refused():
    refused(lambda: Device(key=KEY, identity=[], state=65), "an item must have 5 to 8 bytes, not 9")
    message = "a word must fit an item of 40 bits, not be 0x10000000000"
    refused(lambda: Device(key=KEY, identity=[1 << 40], state=36), message)


def test_a_payload_is_of_whole_items():
    refused(lambda: Items(6).split(bytes(20)), "a payload must be of items of 6 bytes, not of 20 bytes")
