"""Blocks of Gowin primitives: the same bits in the same cycle as their generic twins, and lint."""

import re

import numpy as np
import pytest
from amaranth.hdl import Fragment, signed, unsigned
from family_twins import run
from test_hw_blocks_multiplier import SHAPES, operands

from hw.blocks.multiplier import Multiplier
from hw.emit.lint import lint
from hw.emit.verilog import TOP, convert, modules
from hw.families.registry import get_family
from hw.machine.core import Core
from hw.parameters import Parameters
from sim.backends.rtl import BUILD

SMALL = Parameters(lanes=2, nodes=16, edges=20, materials=3, tables=1)
CYCLES = 20_000


class Recorder:
    """Record the multipliers that a circuit asks for, and offer none."""

    def __init__(self):
        self.multipliers = set()

    def get_multiplier(self, block):
        self.multipliers.add((block.a.shape(), block.b.shape(), block.registers, block.apart))


def test_multipliers_have_their_twins_bits_in_the_same_cycle(rng):
    recorder = Recorder()
    Fragment.get(Core(SMALL), recorder)
    shapes = [*SHAPES, (signed(2), unsigned(1)), (unsigned(18), signed(2))]
    registers = (2, False), (3, False), (3, True)
    asked = sorted(recorder.multipliers | {(*pair, *how) for pair in shapes for how in registers}, key=str)
    inputs = [dict(zip("ab", operands((a, b), rng, CYCLES), strict=True)) for a, b, *_ in asked]
    inputs = [{name: np.array(values[:CYCLES]) for name, values in pair.items()} for pair in inputs]
    blocks = [Multiplier(a, b, registers=registers, apart=apart) for a, b, registers, apart in asked]
    outputs = run(blocks, inputs, BUILD, "gowin")
    for (a, b, registers, _), given, pair in zip(asked, inputs, outputs, strict=True):
        product = given["a"] * given["b"] & (1 << a.width + b.width) - 1
        for output in pair:
            assert np.array_equal(output[registers:].astype(np.int64), product[:-registers]), (a, b, registers)
        assert len(set(pair[1].tolist())) > min(CYCLES, 1 << a.width + b.width) // 8


@pytest.mark.parametrize(("width", "blocks"), [(18, 1), (19, 0), (1, 1)])
def test_a_multiplier_that_does_not_fit_stays_generic(width, blocks):
    for a, b in ((width, 18), (18, width)):
        text = convert(Multiplier(signed(a), unsigned(b), registers=3), "block", get_family("gowin").blocks)
        assert len(re.findall(r"^  MULT27X36 ", text, re.MULTILINE)) == blocks


@pytest.mark.campaign
def test_verilator_finds_nothing_but_what_is_waived(tmp_path):
    lane, top, _ = modules(Parameters(lanes=1, nodes=16, edges=16, materials=2, tables=1, family="gowin"))
    path = tmp_path / "rheogate.v"
    path.write_text(f"{top}\n{lane}")
    assert lint(path, top=TOP, family="gowin") == []
