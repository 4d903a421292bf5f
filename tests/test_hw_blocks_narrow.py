"""The multiplier of lookup tables: exact products, after its latency."""

from functools import partial

import numpy as np
import pytest
from amaranth.hdl import signed, unsigned
from hw_objects import refused
from test_hw_blocks_multiplier import operands, products

from hw.blocks.narrow import NarrowMultiplier


@pytest.mark.parametrize("a", [signed(18), unsigned(16), signed(2), unsigned(1)], ids=str)
@pytest.mark.parametrize(("bits", "registers"), [(8, 3), (8, 5), (7, 3), (5, 4), (4, 2), (2, 1), (1, 1)])
def test_products_are_exact(a, bits, registers, rng):
    x, y = operands((a, unsigned(bits)), rng)
    made = products(NarrowMultiplier(a, unsigned(bits), registers=registers), x, y)
    assert made == [p * q for p, q in zip(x, y, strict=True)]


def test_exhaustively_at_small_widths():
    a, b = (grid.ravel().tolist() for grid in np.meshgrid(np.arange(-8, 8), np.arange(16)))
    made = products(NarrowMultiplier(signed(4), unsigned(4), registers=2), a, b)
    assert made == [x * y for x, y in zip(a, b, strict=True)]


def test_wrong_operands_are_refused():
    make = partial(NarrowMultiplier, signed(18))
    refused(partial(make, signed(8), registers=3), "the narrow operand must be unsigned, not signed(8)")
    refused(partial(make, unsigned(9), registers=3), "registers must be at least 4, not 3")
    refused(partial(make, unsigned(1), registers=0), "registers must be at least 1, not 0")
