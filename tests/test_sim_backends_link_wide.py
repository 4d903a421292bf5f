"""A circuit with the widest words and AXES=1: the host reads both from it, and no bit is lost on the line."""

import re

import numpy as np
import pytest
from served import served

from golden.datapath.formats import Formats
from hw.map.control import Control
from hw.map.memory_map import Map, Region
from hw.parameters import Parameters
from sim.backends.link.board import Board

WIDE = Parameters(lanes=1, nodes=32, edges=64, materials=2, tables=1, axes=1, formats=Formats(18, 44))


@pytest.fixture(scope="module")
def board():
    with served(WIDE) as service:
        found = Board.at(service.url)
        yield found
        found.close()


def test_the_host_reads_the_parameters(board):
    assert board.parameters == WIDE and board.session.identity.circuit["axes"] == 1
    axes = board.read([Map(WIDE).address(Region.CONTROL, 0, Control.AXES)])
    assert axes.tolist() == [1]


def test_no_bit_of_a_wide_word_is_lost(board, rng):
    memory, count = Map(WIDE), WIDE.nodes
    words = [int(word) for word in rng.integers(0, 1 << 44, 2 * count)]
    words[:4] = [(1 << 44) - 1, 1 << 43, 1 << 40, 0]
    addresses = [memory.address(Region.NODE, name, node) for name in ("x_x", "v_z") for node in range(count)]
    board.write(zip(addresses, words, strict=True))
    assert np.array_equal(board.read(addresses), words)
    board.verify(zip(addresses, words, strict=True))


def test_a_word_that_is_too_long_is_refused(board):
    address = Map(WIDE).address(Region.NODE, "x_x", 0)
    before = board.read([address])
    with pytest.raises(ValueError, match=re.escape(f"a word must have at most 44 bits, not be {1 << 44:#x}")):
        board.write([(address, 1 << 44)])
    assert np.array_equal(board.read([address]), before)
