"""Blocks of ECP5 primitives: the same bits in the same cycle as their generic twins, and as few blocks as can be."""

import itertools
import math
import re
from fnmatch import fnmatch

import numpy as np
import pytest
from amaranth.hdl import Fragment, signed, unsigned
from family_twins import run
from integer_objects import random_image
from rtl_objects import rtl_machine
from test_hw_blocks_multiplier import SHAPES, operands

import sim.backends.simulated_circuit
from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.blocks.multiplier import Multiplier
from hw.blocks.shifter import ShiftStage
from hw.emit.lint import lint
from hw.emit.verilog import TOP, convert, modules
from hw.families.ecp5.blocks import BLOCK_RAM_SHAPES
from hw.families.registry import get_family
from hw.machine.core import Core
from hw.parameters import Parameters
from sim.backends.native import NativeMachine
from sim.backends.rtl import BUILD

SMALL = Parameters(lanes=2, nodes=16, edges=20, materials=3, tables=1)
CYCLES = 20_000


class Recorder:
    """Record the blocks that a circuit asks for, and offer none."""

    def __init__(self):
        self.multipliers, self.rams, self.shifts = set(), set(), set()

    def get_multiplier(self, block):
        self.multipliers.add((block.a.shape(), block.b.shape(), block.registers, block.apart))

    def get_shift_stage(self, block):
        self.shifts.add((block.i.shape(), len(block.times), block.places, block.left))

    def get_block_ram(self, block):
        self.rams.add((len(block.data), block.depth, tuple(block.init)))


@pytest.fixture(scope="module")
def asked():
    recorder = Recorder()
    for parameters in (Parameters(), SMALL):
        Fragment.get(Core(parameters), recorder)
    return recorder


def multipliers(asked):
    """The circuit's multipliers, then each pair of signs and some widths, without pipeline register, with it, and with
    one outside of the block."""
    shapes = [*SHAPES, (signed(2), unsigned(1)), (unsigned(18), signed(2))]
    registers = (2, False), (3, False), (3, True)
    return sorted(asked.multipliers | {(*pair, *how) for pair in shapes for how in registers}, key=str)


def rams(asked, rng):
    """The circuit's memories, then each tiling: full and with contents, and empty with one bit too many."""
    full = [(width, depth, tuple(rng.integers(1 << width, size=depth).tolist())) for width, depth in BLOCK_RAM_SHAPES]
    others = [(1, 1), (36, 3), (5, 513), *[(width + 1, depth) for width, depth in BLOCK_RAM_SHAPES[1:]]]
    return sorted(asked.rams) + full + [(*size, ()) for size in others]


def traffic(width, depth, rng):
    """All words in order, then random reads and writes, many of them of the same few words."""
    few = rng.choice([0, depth // 2, depth - 1], (2, CYCLES))
    to, source = np.where(rng.random((2, CYCLES)) < 0.5, few, rng.integers(depth, size=(2, CYCLES)))
    data = rng.integers(1 << width, size=CYCLES)
    data[::7], data[::11] = 0, (1 << width) - 1
    write = rng.random(CYCLES) < 0.6
    write[:depth], source[:depth] = False, np.arange(depth)
    return {"write": write, "write_address": to, "write_data": data, "address": source}


@pytest.fixture(scope="module")
def twins(asked):
    """Return (block, inputs, outputs of it and of its twin) for all multipliers, all block RAMs and all shifts."""
    rng = np.random.default_rng(1)
    of_two, of_words = multipliers(asked), rams(asked, rng)
    inputs = [dict(zip("ab", operands((a, b), rng, CYCLES), strict=True)) for a, b, *_ in of_two]
    inputs = [{name: np.array(values[:CYCLES]) for name, values in pair.items()} for pair in inputs]
    inputs += [traffic(width, depth, rng) for width, depth, _ in of_words]
    of_places = sorted(asked.shifts, key=str)
    inputs += [
        {
            "i": rng.integers(1 << shape.width, size=CYCLES) - (shape.signed << shape.width - 1),
            "times": rng.integers(1 << bits, size=CYCLES),
        }
        for shape, bits, _, _ in of_places
    ]
    blocks = [Multiplier(a, b, registers=registers, apart=apart) for a, b, registers, apart in of_two]
    blocks += [BlockRam(width=width, depth=depth, init=init) for width, depth, init in of_words]
    blocks += [ShiftStage(*stage, left=left) for *stage, left in of_places]
    outputs = run(blocks, inputs, BUILD)
    groups = of_two, of_words, of_places
    together = iter(list(zip([block for group in groups for block in group], inputs, outputs, strict=True)))
    return [list(itertools.islice(together, len(group))) for group in groups]


def test_multipliers_have_their_twins_bits_in_the_same_cycle(asked, twins):
    assert {apart for *_, apart in asked.multipliers} == {False, True}
    for (a, b, registers, _), inputs, (generic, ecp5) in twins[0]:
        product = inputs["a"] * inputs["b"] & (1 << a.width + b.width) - 1
        for output in (generic, ecp5):
            assert np.array_equal(output[registers:].astype(np.int64), product[:-registers]), (a, b, registers)
        assert len(set(ecp5.tolist())) > min(CYCLES, 1 << a.width + b.width) // 8


def test_shifts_have_their_twins_bits(twins):
    for (shape, _, places, left), inputs, outputs in twins[2]:
        i, by = inputs["i"], inputs["times"] * places
        shifted = np.where(by < 63, i << by if left else i >> by, 0 if left else i >> 62) & (1 << shape.width) - 1
        for output in outputs:
            assert np.array_equal(output.astype(np.int64), shifted), (shape, places, left)
    assert {left for (*_, left), _, _ in twins[2]} == {False, True}


def test_block_rams_have_their_twins_bits_in_the_same_cycle(twins):
    """But for words that are read in the cycle in which they are written, whose twins differ on purpose."""
    for block, inputs, (generic, ecp5) in twins[1]:
        collides = (inputs["write"] & (inputs["write_address"] == inputs["address"]))[:-READ_LATENCY]
        same = (generic == ecp5)[READ_LATENCY:]
        assert same[~collides].all(), block
        assert not same[collides].all() and (~collides).sum() > CYCLES // 3
        assert len(set(ecp5.tolist())) > min(CYCLES // 8, 1 << block[0] - 1)


def test_what_a_block_ram_starts_with_is_read_as_it_is(twins):
    for (_, depth, init), _, (generic, ecp5) in twins[1]:
        for output in (generic, ecp5):
            assert tuple(output[READ_LATENCY : depth + READ_LATENCY].tolist()) == (init or (0,) * depth)


def placed(block):
    text = convert(block, "block", get_family("ecp5").blocks)
    return re.findall(r"^  (MULT18X18D|PDPW16KD|DP16KD) #", text, re.MULTILINE)


@pytest.mark.parametrize(
    ("width", "depth", "blocks"),
    [
        (36, 16, ["PDPW16KD"]),
        (8, 512, ["PDPW16KD"]),
        (36, 512, ["PDPW16KD"]),
        (37, 512, ["PDPW16KD"] * 2),
        (18, 513, ["DP16KD"]),
        (36, 1024, ["DP16KD"] * 2),
        (36, 2048, ["DP16KD"] * 4),
        (33, 2048, ["DP16KD"] * 4),
        (36, 4096, ["DP16KD"] * 9),
        (2, 8192, ["DP16KD"]),
        (3, 16384, ["DP16KD"] * 3),
        (1, 16385, []),
    ],
)
def test_a_memory_takes_as_few_blocks_as_hold_it(width, depth, blocks):
    assert placed(BlockRam(width=width, depth=depth)) == blocks
    if blocks:
        assert len(blocks) == min(math.ceil(width / bits) for bits, words in BLOCK_RAM_SHAPES if words >= depth)


@pytest.mark.parametrize(
    ("width", "registers", "apart", "blocks"),
    [
        (18, 2, False, 1),
        (18, 3, False, 1),
        (18, 4, False, 0),
        (19, 3, False, 0),
        (1, 3, False, 1),
        (18, 2, True, 1),
        (18, 4, True, 1),
        (18, 5, True, 0),
    ],
)
def test_a_multiplier_that_does_not_fit_stays_generic(width, registers, apart, blocks):
    for a, b in ((width, 18), (18, width)):
        assert len(placed(Multiplier(signed(a), unsigned(b), registers=registers, apart=apart))) == blocks


@pytest.fixture(scope="module")
def emitted():
    return modules(Parameters(lanes=2, nodes=16, edges=60, materials=8, tables=3, family="ecp5"))


@pytest.mark.campaign
def test_a_simulated_circuit_of_primitives_has_the_models_bits(emitted, monkeypatch, rng):
    """The models spoil a word that is read in the cycle in which it is written: the circuit relies on none."""
    image = random_image(rng)
    lane, top, core = emitted
    models = get_family("ecp5").models.read_text()
    monkeypatch.setattr(sim.backends.simulated_circuit, "emit", lambda parameters: (top + lane + models, core))
    circuit = rtl_machine(image, parameters=core.parameters, folder=BUILD)
    model = NativeMachine(image)
    for steps in (1, 3, 50):
        circuit.step(steps)
        model.step(steps)
        for name in ("x", "v", "ratio", "force"):
            assert np.array_equal(getattr(circuit, name), getattr(model, name)), name
    circuit.close()


@pytest.mark.campaign
def test_verilator_finds_nothing_but_what_is_waived(emitted, tmp_path):
    path, excused = tmp_path / "rheogate.v", get_family("ecp5").waivers.read_text()
    path.write_text("\n".join(emitted[:2]))
    assert lint(path, top=TOP, family="ecp5") == []
    found = lint(path, top=TOP, family="ecp5", waivers=None)
    for rule, match in re.findall(r'^lint_off -rule (\w+) -file "\*" -match "(.*)"$', excused, re.MULTILINE):
        assert any(fnmatch(line, f"%Warning-{rule}: *{match}*") for line in found), (rule, match)
    assert "lint_off" in excused
