"""sim.results.step_time: the time of a step, from a run's own count and on boards whose clock is known."""

import json
import re

import pytest
from sim_objects import block

from golden.datapath.rk4 import RK4
from golden.support.errors import InputError
from hw.boards import board as boards
from hw.parameters import Parameters
from sim.encode import limits
from sim.results import step_time
from sim.results.cycles import Wavefront
from sim.results.result import Result

CIRCUIT = {"lanes": 2, "updates": 1, "nodes": 64, "edges": 256, "materials": 2, "tables": 1}
NOTHING = {"lut": 0, "ff": 0, "multipliers": 0, "block_rams": 0, "lut_ram": 0}
TIMING = {
    "version": "0.0.1",
    "board": "ulx3s-85f",
    "circuit": CIRCUIT,
    "resources": NOTHING,
    "seeds": [1],
    "fmax_mhz": [90.0],
    "clock_mhz": 90.0,
    "tools": {},
    "verilog_sha256": "",
    "grade": 6,
    "fmax_min": 90.0,
    "fmax_median": 90.0,
    "limits_mhz": {"multiplier": 200.0, "block_ram": 200.0},
    "frame": NOTHING,
    "critical_path": [],
}


def test_occupancy_is_the_edges_of_all_stages_by_lanes_and_cycles():
    scene = block(steps=(10, 5, 10))
    result = Result("rtl", None, 1.0, cycles=2500, lanes=2, updates=1)
    assert step_time.count(scene, result) == {"cycles_per_step": 100.0, "occupancy": 4 * 23 / 200}
    assert step_time.count(scene, Result("fixed", None, 1.0)) == {"cycles_per_step": None, "occupancy": None}


def test_boards_without_a_timing_result_are_not_timed(tmp_path):
    assert step_time.on_boards(block(), tmp_path) == [{"board": name, "timed": False} for name in boards.timed()]


def test_a_timed_board_takes_the_cycles_of_the_model_at_its_clock(tmp_path):
    (tmp_path / "ulx3s-85f.json").write_text(json.dumps(TIMING))
    scene = block(dim=3)
    found = next(board for board in step_time.on_boards(scene, tmp_path) if board["timed"])
    parameters = Parameters(**CIRCUIT)
    cycles = Wavefront(limits.encode_checked(scene).image, parameters).per_step()
    assert cycles >= RK4.stages * len(scene.mesh.edges) / 2
    assert found == {
        "board": "ulx3s-85f",
        "timed": True,
        "lanes": 2,
        "updates": 1,
        "axes": 3,
        "clock_mhz": 90.0,
        "fits": True,
        "cycles_per_step": cycles,
        "step_us": cycles / 90.0,
        "real_time": pytest.approx(scene.dt / (cycles / 90e6)),
    }


def test_a_board_that_updates_one_axis_at_a_time_takes_longer(tmp_path):
    def timed(axes):
        (tmp_path / "ulx3s-85f.json").write_text(json.dumps(TIMING | {"circuit": CIRCUIT | {"axes": axes, "lanes": 4}}))
        return next(board for board in step_time.on_boards(block(), tmp_path) if board["timed"])

    whole, in_turn = timed(3), timed(1)
    assert (whole["axes"], in_turn["axes"]) == (3, 1)
    assert in_turn["cycles_per_step"] > whole["cycles_per_step"]


def test_the_clock_of_a_board_is_that_of_its_result(tmp_path):
    (tmp_path / "ulx3s-85f.json").write_text(json.dumps(TIMING))
    assert step_time.clock("ulx3s-85f", tmp_path) == 90.0
    with pytest.raises(
        InputError,
        match=re.escape("--clock must be given, as ulx3s-25f has not been timed (make timing BOARD=ulx3s-25f)"),
    ):
        step_time.clock("ulx3s-25f", tmp_path)


def test_an_object_that_is_too_large_does_not_fit(tmp_path):
    (tmp_path / "ulx3s-85f.json").write_text(json.dumps(TIMING | {"circuit": CIRCUIT | {"nodes": 8}}))
    found = next(board for board in step_time.on_boards(block(), tmp_path) if board["timed"])
    assert found["fits"] is False and "step_us" not in found
