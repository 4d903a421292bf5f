"""sim.report: the page holds the figures of compare.json and all data that it draws, in one file."""

import base64
import json
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from report_objects import FLAT, SOLID, WEIGHT
from sim_objects import block, in_place_of_the_circuit

from sim import report
from sim.backends.registry import BACKENDS
from sim.backends.rtl import RtlBackend
from sim.compare import compare
from sim.report import pack
from sim.report.page import brief, percent, si
from sim.results import energy
from sim.results.face import watched

KEYS = {
    "dim",
    "nodes",
    "edges",
    "steps",
    "lanes",
    "rtl_equals_fixed",
    "max_dx_rel",
    "bound",
    "final_dx_rel",
    "max_da",
    "saturations",
}
SCENES = FLAT, SOLID, WEIGHT


class Page(HTMLParser):
    """The page's figures by scene and key, its text, and the data in its scripts."""

    def __init__(self, text):
        super().__init__()
        self.figures, self.headroom, self.boards, self.text, self.data = {}, {}, {}, "", []
        self.scene, self.script = None, False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.scene = attributes.get("data-scene", self.scene)
        if "data-key" in attributes:
            key, value = attributes["data-key"], json.loads(attributes["data-value"])
            assert self.figures.setdefault(self.scene, {}).setdefault(key, value) == value
        if "data-headroom" in attributes:
            self.headroom.setdefault(self.scene, []).append(json.loads(attributes["data-headroom"]))
        if "data-board" in attributes:
            self.boards.setdefault(self.scene, []).append(attributes["data-board"])
        assert "src" not in attributes and attributes.get("href", "#").startswith(("#", "data:,"))
        self.script = tag in ("script", "style")
        self.json = attributes.get("type") == "application/json"

    def handle_endtag(self, tag):
        self.script = False

    def handle_data(self, data):
        if self.script and self.json:
            self.data.append(json.loads(data))
        elif not self.script:
            self.text += data


@pytest.fixture(scope="module")
def comparisons():
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(BACKENDS, RtlBackend.name, in_place_of_the_circuit())
        return [compare(scene) for scene in SCENES]


@pytest.fixture(scope="module")
def folder(comparisons, tmp_path_factory):
    """A page of three scenes, one of them with a name and a description that need care."""
    out = tmp_path_factory.mktemp("report")
    report.write([report.Section.of(comparison) for comparison in comparisons], out)
    return out


@pytest.fixture(scope="module")
def page(folder):
    return Page((folder / "index.html").read_text())


@pytest.fixture(scope="module")
def entries(folder):
    return json.loads((folder / "compare.json").read_text())


def test_the_figures_are_those_of_the_json(page, entries):
    assert list(page.figures) == [scene.name for scene in SCENES] == [entry["scene"] for entry in entries]
    for entry in entries:
        figures = page.figures[entry["scene"]]
        assert figures.keys() >= KEYS | {"cycles", "cycles_per_step", "occupancy"}
        assert figures == {key: entry[key] for key in figures}
        assert page.headroom[entry["scene"]] == [quantity["headroom_bits"] for quantity in entry["ranges"]]
        assert page.boards[entry["scene"]] == [board["board"] for board in entry["boards"]]
    assert "recovery" in page.figures[FLAT.name] and "recovery" not in page.figures["weight"]


def test_the_figures_can_be_read(page, entries):
    for entry in entries:
        for key in KEYS:
            assert brief(entry[key]) in page.text
        assert percent(entry["occupancy"]) in page.text
        assert si(entry["energy"]["dissipated"], "J") in page.text
    assert page.text.count("energy of its weight") == 1  # only in the scene with gravity
    assert page.text.count("passes") == 2 * len(SCENES)


def test_text_of_the_scene_is_text(page, folder):
    assert "1 < 2 & 3" in page.text and FLAT.name in page.text
    assert "<b>soft" not in (folder / "index.html").read_text()


def test_it_is_one_file(folder):
    assert {path.name for path in folder.iterdir()} == {"index.html", "compare.json"}
    text = (folder / "index.html").read_text()
    assert "http" not in text.replace("http://www.w3.org/2000/svg", "")  # a namespace, not a link


def test_a_scene_that_fails_says_so(tmp_path, entries, comparisons):
    faults = {"fixed": {"velocity": 2}, "rtl": {}}
    failing = entries[1] | {"rtl_equals_fixed": False, "saturations": 2, "faults": faults}
    report.write([replace(report.Section.of(comparisons[1]), entry=failing)], tmp_path)
    page = Page((tmp_path / "index.html").read_text())
    assert page.figures["solid"]["rtl_equals_fixed"] is False
    assert "Fails: saturated: velocity." in page.text
    assert "Fails: the circuit's frames differ from the integer model's." in page.text
    assert "passes" not in page.text


def test_a_board_that_was_timed_tells_its_step(tmp_path, entries, comparisons):
    boards = [
        {"board": "new", "timed": False},
        {"board": "small", "timed": True, "lanes": 1, "updates": 1, "clock_mhz": 100.0, "fits": False},
        {
            "board": "large",
            "timed": True,
            "lanes": 4,
            "updates": 1,
            "clock_mhz": 120.0,
            "fits": True,
            "cycles_per_step": 540,
            "step_us": 4.5,
            "real_time": 55.6,
        },
    ]
    report.write([replace(report.Section.of(comparisons[1]), entry=entries[1] | {"boards": boards})], tmp_path)
    text = Page((tmp_path / "index.html").read_text()).text
    assert "does not fit" in text and "120.0 MHz" in text and "4.50 µs" in text and "56 ×" in text
    assert text.count("not timed") == 1


def unpacked(text, kind, shape):
    return np.frombuffer(base64.b64decode(text), kind).reshape(shape)


def test_what_is_drawn_can_be_had_again(page, comparisons):
    for drawn, comparison in zip(page.data, comparisons, strict=False):
        scene, float64, circuit = comparison.scene, comparison.float64.trajectory, comparison.circuit.trajectory
        shape = len(drawn["frames"]), *scene.mesh.points.shape
        assert drawn["frames"] == list(range(len(scene.frames)))
        x = drawn["x"]["low"] + np.array(drawn["x"]["step"]) * unpacked(drawn["x"]["data"], "<u2", shape)
        np.testing.assert_allclose(x, float64.x, atol=scene.size / 65535)
        largest = np.abs(circuit.x - float64.x).max()
        apart = drawn["apart"]["step"] * unpacked(drawn["apart"]["data"], "<i2", shape)
        np.testing.assert_allclose(apart, circuit.x - float64.x, atol=largest / 65534)
        np.testing.assert_array_equal(unpacked(drawn["edges"], "<u2", (-1, 2)), scene.mesh.edges)
        for name, run in (("float64", float64), ("circuit", circuit)):
            scale = drawn["force"][name]
            force = scale["low"] + (scale["high"] - scale["low"]) / 255 * unpacked(scale["data"], "u1", run.a.shape)
            expected = energy.edge_forces(scene, run).clip(scale["low"], scale["high"])
            np.testing.assert_allclose(force, expected, atol=scale["high"] / 254)
        curves, face = drawn["curves"], watched(scene)
        np.testing.assert_allclose(curves["dx_rel"], comparison.dx_rel(), rtol=1e-5)
        assert curves["force"]["circuit"][0] is None and curves["force"]["circuit"][-1] is not None
        np.testing.assert_allclose(curves["height"]["float64"], face.height(float64), rtol=1e-5)
        assert [phase["end"] for phase in drawn["phases"]] == pytest.approx(circuit.t[scene.end_frames])


def test_many_frames_are_thinned_but_for_the_ends_of_phases():
    scene = block(steps=(601, 3, 700), every=1)
    frames = pack.frames_to_draw(scene)
    assert pack.MOST <= len(frames) <= pack.MOST + 3 and {0, 601, 604, 1304} <= set(frames.tolist())
    assert len(pack.frames_to_draw(block())) == len(block().frames)


def test_a_large_object_has_as_many_frames_as_there_is_room_for(monkeypatch):
    scene = block(dim=3, steps=(60, 20, 30), every=1)
    monkeypatch.setattr(pack, "BUDGET", 20_000)
    frames = pack.frames_to_draw(scene)
    assert 2 * len(scene.phases) < len(frames) < 40
    assert len(frames) * 4 * (scene.mesh.points.size + len(scene.mesh.edges)) < 1.1 * pack.BUDGET


def test_ratios_that_hardly_change_have_a_scale_all_the_same():
    assert pack.ratio_limits([np.array([0.431, 0.6]), np.array([0.5])]) == (0.43, 0.6)
    assert pack.ratio_limits([np.full(3, 0.5)]) == (0.45, 0.55)
    assert pack.ratio_limits([np.ones(3)]) == pytest.approx((0.9, 1.0))


def test_equal_runs_are_no_distance_apart():
    same = pack.centred(np.zeros((2, 3, 2)), 16)
    assert same["step"] == 1.0 and not unpacked(same["data"], "<i2", -1).any()
