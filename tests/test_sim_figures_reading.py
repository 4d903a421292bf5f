"""sim.figures.reading: the readings agree with theory and with float64."""

import math
from dataclasses import replace

import numpy as np
import pytest
from figure_runs import pair

from golden.physics.trajectory import Trajectory
from sim.figures import reading, single_edge
from sim.figures.catalogue import FIGURES, MATERIALS
from sim.figures.runs import EDGE, load
from sim.results.comparison import BOUND

BLOCKS = [*MATERIALS, *(f"{name}-3d" for name in MATERIALS)]
# of k, c1 and c2 in the scenes: q exp(-T / tau), T = 0.105 s from the middle of the press
BACK = {"viscoelastic": 1.0, "plastic": 0.0, "rheological": 35 / 38 * math.exp(-0.105 / (38 / 200))}


@pytest.mark.parametrize("material", MATERIALS)
def test_a_single_edge_comes_back_by_the_closed_form(material):
    back, residual = reading.press(pair(EDGE + material))
    assert back.against == residual.against == "closed form"
    assert back.expected == pytest.approx(0.025 * BACK[material], rel=1e-12)
    assert back.circuit == pytest.approx(0.025 * BACK[material], rel=1e-3, abs=0.025e-3)
    assert residual.circuit == pytest.approx(0.025 * (1 - BACK[material]), rel=1e-3, abs=0.025e-3)
    assert back.passes and residual.passes and back.bound == residual.bound == 1e-3


@pytest.mark.parametrize("name", BLOCKS)
def test_a_block_comes_back_as_in_float64(name):
    back, residual = reading.press(pair(name))
    assert back.against == residual.against == "float64"
    assert back.expected == back.float64 and residual.expected == residual.float64
    assert back.passes and residual.passes and back.bound == residual.bound == 1e-3
    assert back.circuit + residual.circuit == pytest.approx(0.025, abs=1e-8)
    part = back.circuit / 0.025
    if name.startswith("rheological"):
        assert 0.4 < part < 0.6
        assert (
            back.scale == back.expected and residual.scale == residual.expected
        )  # relative to itself, not to the press
    else:
        assert part == pytest.approx(float(name.startswith("viscoelastic")), abs=2e-3)


def test_the_closed_form_is_that_of_the_press_that_was_made():
    """At constant speed over t it is D q tau / t (1 - exp(-t / tau)) exp(-hold / tau), (t / tau)^2 / 24 above."""
    material = load("rheological").materials[0]
    q, tau, t = 35 / 38, 38 / 200, single_edge.PRESS * single_edge.DT
    exact = 0.025 * q * tau / t * (1 - math.exp(-t / tau)) * math.exp(-single_edge.HOLD * single_edge.DT / tau)
    assert exact / single_edge.bounce_back(material) - 1 == pytest.approx((t / tau) ** 2 / 24, rel=0.01)
    back, _ = reading.press(pair("edge-rheological"))
    assert back.float64 == pytest.approx(exact, rel=1e-6)  # Runge-Kutta's error is below


@pytest.mark.parametrize("material", MATERIALS)
def test_the_sides_of_a_solid_bulge(material):
    block = pair(f"{material}-3d")
    circuit, float64 = (reading.bulges(block.scene, x[block.released]) for x in block.x)
    assert (circuit > 0.01 * block.scene.size).all()  # each of the four sides
    assert np.abs(circuit - float64).max() <= 1e-4 * block.scene.size
    read = reading.bulge(block)
    assert read.circuit == pytest.approx(circuit.mean()) and read.bound == 1e-4 and read.passes
    assert reading.bulge_over_time(block, block.circuit.trajectory)[block.released] == read.circuit


def test_bulges_of_a_known_deformation():
    scene = load("plastic-3d")
    moved = scene.mesh.points * (1.1, 1.2, 0.7) - (0.02, 0, 0)  # m: x of the sides -0.02 and 0.09, y 0 and 0.12
    np.testing.assert_allclose(reading.bulges(scene, moved), [0.02, -0.01, 0, 0.02], atol=1e-15)


def test_a_block_under_its_weight():
    collapses, holds = (reading.fall(pair(f"gravity-{name}")) for name in ("collapses", "holds"))
    assert collapses.circuit > 0.25 * collapses.scale and 0 < holds.circuit < 0.02 * holds.scale
    assert collapses.passes and holds.passes and (collapses.bound, holds.bound) == (BOUND[False], BOUND[True])


@pytest.mark.parametrize("name", sorted({scene for figure in FIGURES.values() for scene in figure.scenes}))
def test_every_run_stays_by_float64_and_within_its_formats(name):
    read = reading.apart(pair(name))
    assert 0 < read.difference <= read.bound and read.passes
    assert not pair(name).circuit.faults


def test_deformation_is_the_way_of_the_pressed_face():
    block = pair("rheological")
    way = reading.deformation(block, block.circuit.trajectory)
    assert way[0] == 0 and way[block.released] == pytest.approx(0.025, abs=1e-8)
    back, residual = reading.press(block)
    assert (way[-1], way[block.released] - way[-1]) == pytest.approx((residual.circuit, back.circuit))


def test_a_run_that_is_off_does_not_pass():
    """The circuit's last frame lifted by 0.2 % of the press: bounce-back and residual both miss their bound."""
    block = pair("rheological")
    run = block.circuit.trajectory
    x = run.x.copy()
    x[-1, block.face.nodes, 1] += 2e-3 * 0.025
    off = replace(
        block, circuit=replace(block.circuit, trajectory=Trajectory(run.t, x, run.v, run.a, run.reaction, run.edges))
    )
    back, residual = reading.press(off)
    assert not back.passes and not residual.passes and not reading.apart(off).passes
    assert back.shortcoming() == "rheological: bounce-back must be within 0.001 of float64, not 0.00428 off"


def test_sides_that_go_inwards_do_not_pass():
    read = replace(reading.bulge(pair("plastic-3d")), circuit=-1e-3, expected=-1e-3)
    assert read.difference == 0 and not read.passes
    assert read.shortcoming() == (
        "plastic-3d: side bulge must be within 0.0001 of float64, not 0 off, and above 0, not -0.001 m"
    )
