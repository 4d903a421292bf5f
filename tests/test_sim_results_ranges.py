"""sim.results.ranges: the ranges of the datapath's quantities, measured without changing a bit."""

import json
from dataclasses import replace

import numpy as np
import pytest
from sim_objects import block

from golden.datapath.formats import Formats
from golden.datapath.machine import Machine
from golden.datapath.quantities import QUANTITIES
from golden.numbers.qarray import QArray
from sim.encode import limits
from sim.results import ranges
from sim.run import run

PRESENT = {"along", "rho_middle", "sigma_middle"}
"""Named by their formats, but not made by rounding: copies of what is listed, constants, and one branch of two."""


@pytest.fixture(scope="module")
def watched_by_hand():
    """Return (scene, its run, the ranges seen by a machine that went through the whole run)."""
    scene = block("rheological-force", steps=(10, 5, 10), every=1)
    seen, names = ranges.Ranges(), {}

    def watch(values):
        seen(values)
        for name, value in values.items():
            for number in value if isinstance(value, list) else [value]:
                if isinstance(number, QArray):
                    names[name] = number.fmt.name

    loaded = limits.encode_checked(scene)
    machine = Machine(loaded.image, watch)
    for phase in scene.phases:
        machine.restart(loaded.start(phase, machine.v))
        machine.step(phase.steps)
    return scene, run(scene, "fixed", engine="numpy"), seen.entries(loaded.units), machine, names


def test_watching_changes_no_bit(watched_by_hand):
    scene, result, _, machine, _ = watched_by_hand
    loaded = limits.encode_checked(scene)
    for name, order in (("x", loaded.node_order), ("v", loaded.node_order), ("ratio", loaded.edge_order)):
        np.testing.assert_array_equal(getattr(machine, name), getattr(result.raw, name)[-1][order])


def test_steps_from_the_frames_are_those_of_the_run(watched_by_hand):
    scene, result, entries, _, _ = watched_by_hand
    told = []
    assert ranges.measure(scene, result.raw, told.append) == entries
    assert told == list(range(1, 26))
    json.dumps(entries, allow_nan=False)


def test_every_number_is_counted(watched_by_hand):
    scene, _, entries, _, _ = watched_by_hand
    calls, edges, nodes = 25 * 4, len(scene.mesh.edges), len(scene.mesh.points)
    by_name = {entry["quantity"]: entry for entry in entries}
    for name, count in (("square", edges), ("pull", 3 * edges), ("x", 3 * nodes), ("factor", nodes)):
        assert sum(by_name[name]["counts"]) == calls * count
    assert list(by_name) == [q.name for q in QUANTITIES.values() if q.measured]


def test_every_quantity_with_a_format_of_its_own_is_there(watched_by_hand):
    *_, names = watched_by_hand
    formats = {q.name for q in Formats().all()}
    missing = {name for name, fmt in names.items() if fmt in formats} - ranges.MEASURED
    assert missing == PRESENT


def test_the_largest_and_the_headroom(watched_by_hand):
    scene, result, entries, _, _ = watched_by_hand
    by_name = {entry["quantity"]: entry for entry in entries}
    x = by_name["x"]
    largest = np.abs(result.raw.x[1:]).max()  # the stages in between stay within
    assert x["largest"] == pytest.approx(largest * 2.0**-33 * scene.size, rel=1e-3) and x["unit"] == "m"
    assert x["headroom_bits"] == pytest.approx(35 - np.log2(largest), abs=2e-3)
    assert 2 ** (35 - x["headroom_bits"]) < 2 ** (np.flatnonzero(x["counts"])[-1])
    speed = np.abs(result.raw.v).max() * 2.0**-35 * result.units.velocity
    assert by_name["v"]["largest"] >= speed * (1 - 1e-12) and by_name["v"]["unit"] == "m/s"
    assert (by_name["pull"]["unit"], by_name["ratio_next"]["unit"]) == ("N", "")
    for entry in entries:
        assert entry["normalised"] == QUANTITIES[entry["quantity"]].normalised
        assert (entry["largest"] is None) == entry["normalised"]
        assert entry["headroom_bits"] < 2 or not entry["normalised"]  # they fill their bits on purpose


def test_what_saturates_has_no_headroom():
    scene = block("viscoelastic", steps=(6, 1, 1), every=1)
    loaded, seen = limits.encode_checked(scene), ranges.Ranges()
    machine = Machine(loaded.image, seen)
    machine.step(5)
    machine.v = np.full_like(machine.v, Formats().velocity.raw_max)
    machine.v[::2] *= -1
    machine.step()
    assert machine.faults["trial force"] > 0
    by_name = {entry["quantity"]: entry for entry in seen.entries(loaded.units)}
    assert by_name["dashpot"]["headroom_bits"] == 0 == by_name["v"]["headroom_bits"]


def test_trial_forces_of_several_materials_have_no_common_unit():
    units = limits.encode_checked(block()).units
    assert ranges.in_si("trial full scale", units) == (units.trial[0], "N")
    assert ranges.in_si("trial full scale", replace(units, trial=(1.0, 2.0))) == (1.0, "full scale")


def test_sampled_steps_are_spread_evenly_and_hold_the_starts_of_phases():
    scene = block(steps=(400, 3, 300), every=1)
    frames = ranges.sampled(scene)
    assert ranges.SAMPLES <= len(frames) <= ranges.SAMPLES + 2
    assert {0, 400, 403} <= set(frames.tolist()) and frames[-1] == len(scene.frames) - 2
    few = block(steps=(40, 20, 30), every=6)
    assert len(ranges.sampled(few)) == len(few.frames) - 1
