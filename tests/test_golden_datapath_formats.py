"""The format table: every width follows from two word lengths, and accuracy from the shorter of them."""

import numpy as np
import pytest
from integer_objects import MATERIALS, irregular, pressed

from golden.datapath import records
from golden.datapath.formats import Formats, table
from golden.datapath.machine import Machine
from golden.datapath.tables import inverse_table
from golden.physics.model import simulate
from sim.encode.encode import encode

FMT = Formats()
WORDS = [(12, 24), (14, 32), (16, 32), (18, 36), (20, 40), (22, 44)]


@pytest.mark.parametrize(
    ("operand", "state", "message"),
    [
        (11, 36, "operand must be 12 to 24 bits, not 11"),
        (25, 44, "operand must be 12 to 24 bits, not 25"),
        (12, 23, "state must be 24 to 44 bits, not 23"),
        (18, 45, "state must be 24 to 44 bits, not 45"),
        (19, 36, "operand must be at most 18 bits, half of a state word, not 19"),
        (24, 44, "operand must be at most 22 bits, half of a state word, not 24"),
    ],
)
def test_word_lengths_out_of_range_are_refused(operand, state, message):
    with pytest.raises(ValueError, match=f"^{message}$"):
        Formats(operand, state)


@pytest.mark.parametrize(("operand", "state"), WORDS)
def test_widths_are_the_two_word_lengths(operand, state):
    fmt = Formats(operand, state)
    states = "position", "velocity", "displacement", "ratio", "length", "trial", "creep", "accumulator"
    assert all(getattr(fmt, name).width == state and getattr(fmt, name).signed for name in states)
    operands = "mantissa", "square", "inverse", "share", "direction", "rate"
    assert all(getattr(fmt, name).width == operand for name in operands)
    # table words are two operands long for each quantity
    assert records.inverse_word(fmt).width == 2 * operand
    assert records.damper_word(fmt).width == 4 * operand


@pytest.mark.parametrize(("operand", "state"), WORDS)
def test_no_sum_of_forces_of_as_many_edges_as_promised_leaves_the_accumulator(operand, state):
    fmt = Formats(operand, state)
    most = 1 << fmt.degree_bits
    assert fmt.force.frac_bits == fmt.accumulator.frac_bits
    assert fmt.accumulator.raw_min <= most * fmt.force.raw_min
    assert most * fmt.force.raw_max <= fmt.accumulator.raw_max


@pytest.mark.parametrize(("operand", "state"), WORDS)
def test_the_slopes_of_the_inverse_square_root_fit_unclipped(operand, state):
    fmt = Formats(operand, state)
    steepest = 0.5 * 4 / (1 << fmt.inverse_index.width)  # 1/2 at q = 1, over a segment
    slopes = inverse_table(fmt)["slope"]
    assert 0.99 * steepest < slopes.max() * fmt.inverse_slope.lsb < steepest
    assert slopes.max() < fmt.inverse_slope.raw_max


def test_every_format_that_reports_or_is_documented_has_its_own_name():
    names = [q.name for q in FMT.all()]
    assert len(set(names)) == len(names) and "" not in names
    assert {"position", "velocity", "force", "mantissa", "octave"} <= set(names)


def test_the_table_of_the_documentation_has_a_row_for_each_format():
    lines = table(FMT).splitlines()
    assert lines[0] == "| quantity | format | bits | range | step | unit |"
    assert len(lines) == 2 + len(FMT.all())
    assert "| position | Q3.33 | 36 | -4 to 4 | 2^-33 | size |" in lines
    assert "| mantissa | UQ0.18 | 18 | 0 to 1 | 2^-18 | 2^shift |" in lines


def test_accuracy_improves_with_the_bits_of_operands(rng):
    """The mean error falls by a factor of four with two bits more: it is about an LSB of an operand."""
    scene = pressed(irregular((4, 4), rng), MATERIALS["rheological-force"], 45)
    exact = simulate(scene).x[-1]
    errors = []
    for operand, state in WORDS:
        loaded = encode(scene, Formats(operand, state))
        machine = Machine(loaded.image)
        for phase in scene.phases:
            machine.restart(loaded.start(phase, machine.v))
            machine.step(phase.steps)
        assert not machine.faults
        errors.append(np.abs(loaded.positions(machine.x) - exact).max() / scene.size)
        assert errors[-1] < 2.0**-operand
    print("largest errors, in sizes:", [f"{error:.2g}" for error in errors])
    gains = np.divide(errors[:-1], errors[1:])
    assert gains.min() > 1 and 3 < gains.prod() ** (1 / len(gains)) < 5.5
