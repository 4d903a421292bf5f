"""The axes of a node come one after the other, each with all that came with the node."""

from hw_objects import simulate

from golden.numbers.graph import AXES
from hw.machine.axis_serializer import AxisSerializer

WIDTH = 7


def test_every_axis_of_every_node_comes_once(rng):
    dut, expected, seen = AxisSerializer(width=WIDTH), [], []

    async def bench(ctx):
        for _ in range(50):
            node = int(rng.integers(1 << WIDTH))
            for cycle in range(len(AXES) + int(rng.integers(0, 4))):
                ctx.set(dut.node_valid, cycle == 0)
                ctx.set(dut.node, node if cycle == 0 else int(rng.integers(1 << WIDTH)))
                await ctx.tick()
                axis = cycle if cycle < len(AXES) else None
                expected.append(None if axis is None else (node, axis, axis == 0, axis == len(AXES) - 1))
                ports = dut.held, dut.axis, dut.first, dut.last
                seen.append(tuple(map(ctx.get, ports)) if ctx.get(dut.valid) else None)
                assert ctx.get(dut.valid) or not (ctx.get(dut.first) or ctx.get(dut.last))

    simulate(dut, bench)
    assert seen == expected and None in seen
