"""The report's page in a browser: it opens from disk, plays, turns, and shows what was computed."""

import json
import re
import shutil
import time
from pathlib import Path

import numpy as np
import pytest
from browser import Opened, chromium
from report_objects import FLAT, SOLID
from sim_objects import in_place_of_the_circuit

from golden.scene.load import load
from sim import report
from sim.backends.registry import BACKENDS
from sim.backends.rtl import RtlBackend
from sim.compare import compare, complete
from sim.report.page import slug
from sim.results.comparison import power

FLAT_ID, SOLID_ID = slug(FLAT.name), slug(SOLID.name)
SHIPPED = Path(__file__).parents[1] / "scenes"
INTERACTIVE, LARGEST = 2.0, 15e6  # s, bytes
RATIO, FORCE, APART = (f"[data-role=colour][value={value}]" for value in ("ratio", "force", "apart"))


@pytest.fixture(scope="module")
def comparisons():
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(BACKENDS, RtlBackend.name, in_place_of_the_circuit())
        return [compare(scene) for scene in (FLAT, SOLID)]


@pytest.fixture(scope="module")
def folder(comparisons, tmp_path_factory):
    out = tmp_path_factory.mktemp("page")
    report.write([report.Section.of(comparison) for comparison in comparisons], out)
    return out


@pytest.fixture(scope="module")
def browser():
    with chromium() as found:
        yield found


@pytest.fixture
def opened(browser, folder):
    page = Opened(browser, folder / "index.html")
    yield page
    page.page.close()


@pytest.mark.parametrize("ci, outcome", [("true", pytest.fail.Exception), (None, pytest.skip.Exception)])
def test_without_a_browser_tests_are_skipped_but_not_in_continuous_integration(monkeypatch, ci, outcome):
    monkeypatch.setattr(shutil, "which", lambda program: None)
    monkeypatch.delenv("CI", raising=False)
    if ci:
        monkeypatch.setenv("CI", ci)
    message = "a browser (chromium) is missing, with which the report is tested: install it (Debian: apt install "
    with pytest.raises(outcome, match=f"^{re.escape(message)}chromium\\)$"), chromium():
        pass


def test_it_opens_from_disk_without_a_word(opened):
    for name in (FLAT_ID, SOLID_ID):
        opened.section(name)
    opened.page.emulate_media(color_scheme="dark")
    opened.page.wait_for_timeout(100)
    assert opened.complaints == []
    assert {url for url in opened.requests if not url.startswith("data:")} == {opened.url}


def soon(browser, path):
    """Return the page, and the time until it could be used: the better of two, as the machine may be busy."""
    taken = []
    for _ in range(2):
        began = time.perf_counter()
        page = Opened(browser, path)
        page.page.keyboard.press("Tab")
        assert page.page.evaluate("document.activeElement.tagName") == "A"
        taken.append(time.perf_counter() - began)
    return page, min(taken)


def test_it_is_interactive_soon(browser, folder):
    page, taken = soon(browser, folder / "index.html")
    assert taken < INTERACTIVE
    page.page.close()


@pytest.mark.campaign
def test_all_shipped_scenes_are_interactive_soon_and_not_large(browser, tmp_path):
    scenes = [load(path) for path in sorted(SHIPPED.glob("*.toml"))]
    assert len(scenes) >= 10
    report.write([report.Section.of(complete(scene, {}, ("float", "fixed"))) for scene in scenes], tmp_path)
    size = (tmp_path / "index.html").stat().st_size
    page, taken = soon(browser, tmp_path / "index.html")
    print(f"{len(scenes)} scenes: {size / 1e6:.1f} MB, interactive after {taken:.2f} s")
    for scene in scenes:
        page.section(slug(scene.name))
    assert size <= LARGEST and taken < INTERACTIVE and page.complaints == []
    page.page.close()


@pytest.mark.parametrize("name", [FLAT_ID, SOLID_ID])
def test_it_plays_and_pauses(opened, name):
    section = opened.section(name)
    section.locator("[data-role=frame]").fill("0")
    first = opened.pixels(name)
    button = section.locator("[data-role=play]")
    section.locator("[data-role=speed]").select_option("100")
    button.click()
    opened.page.wait_for_function("name => document.getElementById(name).dataset.frame > 1", arg=name)
    assert button.text_content() == "Pause"
    section.locator(".view canvas").focus()
    opened.page.keyboard.press(" ")
    assert button.text_content() == "Play"
    frame = opened.frame(name)
    assert opened.pixels(name) != first
    opened.page.wait_for_timeout(150)
    assert opened.frame(name) == frame


def test_at_the_end_it_stops_and_begins_again(opened):
    section = opened.section(FLAT_ID)
    section.locator(".view canvas").focus()
    opened.page.keyboard.press("End")
    last = opened.frame(FLAT_ID)
    assert str(last) == section.locator("[data-role=frame]").get_attribute("max")
    section.locator("[data-role=speed]").select_option("1")
    opened.page.keyboard.press(" ")
    opened.page.wait_for_function(
        "([name, last]) => Number(document.getElementById(name).dataset.frame) === last", arg=[FLAT_ID, last]
    )
    assert section.locator("[data-role=play]").text_content() == "Play"
    opened.page.keyboard.press(",")
    assert opened.frame(FLAT_ID) == last - 1
    opened.page.keyboard.press("Home")
    assert opened.frame(FLAT_ID) == 0


def test_the_slider_moves_the_curves_and_tells_the_time(opened):
    section = opened.section(SOLID_ID)
    lines = section.locator("line.now")
    assert lines.count() == 4
    before = lines.first.get_attribute("x1")
    section.locator("[data-role=frame]").fill("30")
    assert section.locator("[data-role=time]").text_content() == "24\u00a0ms · release · frame 31 of 36"
    assert lines.first.get_attribute("x1") != before
    assert len({line.get_attribute("x1") for line in lines.all()}) == 1


def test_a_curve_that_is_pressed_moves_the_picture(opened):
    section = opened.section(SOLID_ID)
    chart = section.locator("[data-chart=force] svg")
    box = chart.bounding_box()
    chart.click(position={"x": box["width"] - 19, "y": 60})
    assert opened.frame(SOLID_ID) == 35
    chart.click(position={"x": 53, "y": 60})
    assert opened.frame(SOLID_ID) == 0


def test_a_solid_turns_by_hand_and_by_keys(opened):
    canvas = opened.section(SOLID_ID).locator(".view canvas")
    canvas.scroll_into_view_if_needed()
    first, box = opened.pixels(SOLID_ID), canvas.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    opened.page.mouse.move(x, y)
    opened.page.mouse.down()
    opened.page.mouse.move(x + 60, y - 20)
    opened.page.mouse.up()
    turned = opened.pixels(SOLID_ID)
    canvas.focus()
    opened.page.keyboard.press("ArrowLeft")
    further = opened.pixels(SOLID_ID)
    opened.page.keyboard.press("+")
    larger = opened.pixels(SOLID_ID)
    assert len({first, turned, further, larger}) == 4
    opened.page.keyboard.press("0")
    assert opened.pixels(SOLID_ID) == first


def test_a_flat_object_does_not_turn(opened):
    canvas = opened.section(FLAT_ID).locator(".view canvas")
    first = opened.pixels(FLAT_ID)
    canvas.focus()
    opened.page.keyboard.press("ArrowLeft")
    assert opened.pixels(FLAT_ID) == first


def test_colours_runs_and_enlarged_differences_are_all_different_pictures(opened):
    section = opened.section(SOLID_ID)
    seen = {}
    for colour, words in ((RATIO, "ratio a"), (FORCE, "force of the edges"), (APART, "distance of circuit")):
        section.locator(colour).check()
        seen[colour] = opened.pixels(SOLID_ID)
        assert section.locator("[data-role=title]").text_content().startswith(words)
    assert "N" in _scale(section, FORCE)[0] and _scale(section, APART)[0] == "0"
    assert _scale(section, APART)[2].endswith("m")
    section.locator("[data-role=times]").check()
    seen["times"] = opened.pixels(SOLID_ID)
    section.locator("[data-role=inside]").check()
    seen["inside"] = opened.pixels(SOLID_ID)
    for value in ("float64", "both"):
        section.locator(f"[data-role=run][value={value}]").check()
        seen[value] = opened.pixels(SOLID_ID)
    assert len(set(seen.values())) == len(seen)
    assert section.locator("[data-role=lines]").is_visible() and not section.locator("[data-role=scale]").is_visible()


def _scale(section, colour):
    section.locator(colour).check()
    return [section.locator(f"[data-role={role}]").text_content() for role in ("low", "middle", "high")]


def test_what_is_drawn_is_what_was_computed(opened, comparisons):
    for scene_id, comparison in zip((FLAT_ID, SOLID_ID), comparisons, strict=True):
        opened.section(scene_id)
        scene, float64, circuit = comparison.scene, comparison.float64.trajectory, comparison.circuit.trajectory
        for frame in (0, len(circuit.t) // 2, len(circuit.t) - 1):
            drawn = [
                opened.page.evaluate(f"([id, frame]) => [...recordings.get(id).{what}]", [scene_id, frame])
                for what in ("positions(frame, 0)", "apartOf(frame)")
            ]
            np.testing.assert_allclose(drawn[0], float64.x[frame].ravel(), atol=scene.size / 65535)
            apart = np.linalg.norm(circuit.x[frame] - float64.x[frame], axis=1)
            np.testing.assert_allclose(drawn[1], apart, atol=np.abs(circuit.x - float64.x).max() / 32767)
            shades = opened.page.evaluate(
                "([id, frame]) => [...recordings.get(id).shades(frame, 'ratio', 'circuit')]", [scene_id, frame]
            )
            low, high = (
                opened.page.evaluate(f"id => recordings.get(id).ratio.circuit.{end}", scene_id)
                for end in ("low", "high")
            )
            np.testing.assert_allclose(
                low + (high - low) * np.array(shades), circuit.a[frame].clip(low, high), atol=(high - low) / 255
            )


def test_the_numbers_on_it_are_those_of_the_json(opened, folder):
    entries = json.loads((folder / "compare.json").read_text())
    for entry in entries:
        section = opened.section(slug(entry["scene"]))
        figures = opened.page.evaluate(
            """scene => [...document.querySelectorAll("[data-key]")]
            .filter(part => part.closest("[data-scene]").dataset.scene === scene)
            .map(part => [part.dataset.key, JSON.parse(part.dataset.value)])""",
            entry["scene"],
        )
        assert {key for key, _ in figures} >= {"max_dx_rel", "bound", "saturations", "cycles", "occupancy", "lanes"}
        assert all(value == entry[key] for key, value in figures)
        section.locator(".view canvas").focus()
        opened.page.keyboard.press("End")
        read = section.locator("[data-chart=apart] .key b").text_content()
        assert read == power(entry["final_dx_rel"])
        heat = section.locator("[data-chart=energy] .key .dissipated b").text_content().split("\u00a0")
        factor = {"J": 1, "mJ": 1e-3, "µJ": 1e-6, "nJ": 1e-9}[heat[1]]
        assert float(heat[0]) * factor == pytest.approx(entry["energy"]["dissipated"], rel=6e-3)


def test_the_ranges_are_drawn_when_they_are_opened(opened, folder):
    entry = json.loads((folder / "compare.json").read_text())[1]
    section = opened.section(SOLID_ID)
    assert section.locator("rect.bin").count() == 0
    section.locator("summary").click()
    filled = sum(count > 0 for quantity in entry["ranges"] for count in quantity["counts"])
    opened.page.wait_for_function("id => document.querySelectorAll(`#${id} rect.bin`).length > 0", arg=SOLID_ID)
    assert section.locator("rect.bin").count() == filled


def test_a_narrow_window_needs_no_sideways_scrolling(browser, folder):
    page = Opened(browser, folder / "index.html", viewport={"width": 390, "height": 800})
    page.section(SOLID_ID)
    assert page.page.evaluate("document.documentElement.scrollWidth") <= 390
    page.page.close()
