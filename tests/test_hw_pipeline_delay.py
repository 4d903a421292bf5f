"""Delay lines: every tap is the value so many cycles before, whatever it is made of."""

import re

import pytest
from amaranth.hdl import Module, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from hw_objects import only_asked, simulate

from hw.emit.verilog import convert
from hw.pipeline.delay import LONGEST_RING, SHORTEST_RING, DelayLines, Ring


class Tapped(wiring.Component):
    def __init__(self, taps, reset=False, wire=False):
        self._taps, self._how = taps, {"reset": reset, "wire": wire}
        super().__init__({"i": In(signed(7)), **{f"o{cycles}": Out(signed(7)) for cycles in taps}})

    def elaborate(self, platform):
        m = Module()
        lines = DelayLines(m)
        for cycles in self._taps:
            m.d.comb += getattr(self, f"o{cycles}").eq(lines.later(self.i, cycles, **self._how))
        lines.build()
        return m


@pytest.mark.parametrize("wire", [False, True])
@pytest.mark.parametrize("reset", [False, True])
@pytest.mark.parametrize(
    "taps",
    [
        (0, 1, 2),
        (SHORTEST_RING - 1,),
        (SHORTEST_RING,),
        (LONGEST_RING,),
        (LONGEST_RING + 1,),
        (40, 3, 12, 41, 61),
        (2 * LONGEST_RING,),
    ],
)
def test_taps(taps, reset, wire, rng):
    values = [int(v) for v in rng.integers(-64, 64, 150)]
    dut = Tapped(taps, reset, wire)
    seen = {cycles: [] for cycles in taps}

    async def bench(ctx):
        for value in values:
            ctx.set(dut.i, value)
            for cycles, outputs in seen.items():
                outputs.append(ctx.get(getattr(dut, f"o{cycles}")))
            await ctx.tick()

    simulate(dut, bench)
    for cycles, outputs in seen.items():
        assert outputs[cycles:] == values[: len(values) - cycles]
        assert not reset or outputs[:cycles] == [0] * cycles


@pytest.mark.parametrize("wire", [False, True])
def test_a_register_takes_what_comes_from_logic_before_a_ring_does(wire):
    verilog = convert(Tapped((SHORTEST_RING + 1,), wire=wire), "tapped")
    taken = re.search(r"_ring6 \(.*?\.i\((\w+)\)", verilog, re.DOTALL)[1]
    assert (f"{taken} <= i;" in verilog) == wire


@pytest.mark.parametrize("cycles", [2, LONGEST_RING + 1])
def test_a_ring_of_an_impossible_length_is_refused(cycles):
    with only_asked(), pytest.raises(ValueError, match=f"^cycles must be 3 to {LONGEST_RING}, not {cycles}$"):
        Ring(width=1, cycles=cycles)
