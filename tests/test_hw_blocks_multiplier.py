"""The multiplier: exact products of every kind of operands, after its latency."""

from functools import partial

import numpy as np
import pytest
from amaranth.hdl import signed, unsigned
from hw_objects import refused, simulate
from integer_objects import random_raw

from golden.numbers.qformat import Q
from hw.blocks.multiplier import Multiplier

SHAPES = [(s(a), t(b)) for s in (signed, unsigned) for t in (signed, unsigned) for a, b in ((18, 18), (18, 7), (9, 18))]


def corners(shape):
    q = Q(shape.width, 0, shape.signed)
    middle = {-1, 0, 1} if shape.signed else {0, 1, 1 << shape.width - 1}
    return sorted({q.raw_min, q.raw_min + 1, q.raw_max - 1, q.raw_max} | middle)


def operands(shapes, rng, count=300):
    """All pairs of corners, then random ones."""
    a, b = np.meshgrid(*map(corners, shapes))
    wild = [random_raw(rng, Q(shape.width, 0, shape.signed), count) for shape in shapes]
    return [np.concatenate([pairs.ravel(), random]).tolist() for pairs, random in zip((a, b), wild, strict=True)]


def products(dut, a, b):
    """Return the products of one pair a cycle, read ``dut.registers`` cycles later."""
    results = []

    async def bench(ctx):
        for cycle in range(len(a) + dut.registers):
            if cycle >= dut.registers:
                results.append(ctx.get(dut.product))
            if cycle < len(a):
                ctx.set(dut.a, a[cycle])
                ctx.set(dut.b, b[cycle])
            await ctx.tick()

    simulate(dut, bench)
    return results


@pytest.mark.parametrize("shapes", SHAPES, ids=str)
@pytest.mark.parametrize("registers", [2, 3, 5])
def test_products_are_exact(shapes, registers, rng):
    a, b = operands(shapes, rng)
    assert products(Multiplier(*shapes, registers=registers), a, b) == [x * y for x, y in zip(a, b, strict=True)]


def test_wider_operands_are_legal(rng):
    shapes = signed(24), unsigned(24)
    a, b = operands(shapes, rng)
    assert products(Multiplier(*shapes, registers=3), a, b) == [x * y for x, y in zip(a, b, strict=True)]


def test_exhaustively_at_small_widths():
    shapes = signed(4), unsigned(4)
    a, b = (grid.ravel().tolist() for grid in np.meshgrid(np.arange(-8, 8), np.arange(16)))
    assert products(Multiplier(*shapes, registers=2), a, b) == [x * y for x, y in zip(a, b, strict=True)]


@pytest.mark.parametrize("registers", [0, 1])
def test_it_has_at_least_two_registers(registers):
    make = partial(Multiplier, signed(18), signed(18), registers=registers)
    refused(make, f"registers must be at least 2, not {registers}")
