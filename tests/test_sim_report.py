"""sim.report: the page shows the numbers of compare.json, and pictures of what was computed."""
import json
from dataclasses import replace
from html.parser import HTMLParser

import golden_objects as objects
import numpy as np
import pytest
from sim_objects import DT, MATERIALS, MESHES, block, in_place_of_the_circuit

from golden import mesh
from sim import machines, report
from sim.compare import compare
from sim.report import shapes, surface
from sim.report.page import brief, percent, slug

SHOWN = {"dim", "nodes", "edges", "steps", "lanes", "rtl_equals_fixed", "max_dx_rel", "bound", "final_dx_rel", "max_da",
         "saturations"}


class Page(HTMLParser):
    """The page's figures by scene and key, its text and its pictures."""

    def __init__(self, text):
        super().__init__()
        self.figures, self.pictures, self.text, self.scene = {}, [], "", None
        self.feed(text.partition("</style>")[2])

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "tr" or tag == "section":
            self.scene = attributes.get("data-scene")
        if "data-key" in attributes:
            found = self.figures.setdefault(self.scene, {})
            assert attributes["data-key"] not in found
            found[attributes["data-key"]] = json.loads(attributes["data-value"])
        if tag == "img":
            assert attributes["alt"]
            self.pictures.append(attributes["src"])

    def handle_data(self, data):
        self.text += data


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A page of two scenes, one of them with a name and a description that need care."""
    out = tmp_path_factory.mktemp("report")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(machines, "circuit", in_place_of_the_circuit())
        flat = replace(block("rheological-force", steps=(10, 5, 10)), name="../<b>soft & wet</b>",
                       description="1 < 2 & 3")
        weight = [objects.phase(MESHES[3], 12, objects.bottom(MESHES[3]), name="stand")]
        solid = replace(objects.scene(MESHES[3], MATERIALS["viscoelastic"], DT, weight, 0.01, (0, 0, -9.81), every=4),
                        name="solid")
        report.write([report.section(scene, lanes=2, updates=1, folder=out) for scene in (flat, solid)], out)
    return out


@pytest.fixture
def page(folder):
    return Page((folder / "index.html").read_text())


@pytest.fixture
def entries(folder):
    return json.loads((folder / "compare.json").read_text())


def test_the_figures_are_those_of_the_json(page, entries):
    assert list(page.figures) == ["../<b>soft & wet</b>", "solid"] == [entry["scene"] for entry in entries]
    for entry in entries:
        shown = page.figures[entry["scene"]]
        assert shown.keys() >= SHOWN | {"cycles"}
        assert shown == {key: entry[key] for key in shown}
    assert "recovery" in page.figures["../<b>soft & wet</b>"] and "recovery" not in page.figures["solid"]


def test_the_figures_can_be_read(page, entries):
    for entry in entries:
        for key in SHOWN:
            assert brief(entry[key]) in page.text
    assert page.text.count("passes") == 2


def test_text_of_the_scene_is_text(page, folder):
    assert "1 < 2 & 3" in page.text and "../<b>soft & wet</b>" in page.text
    assert "<b>soft" not in (folder / "index.html").read_text()


def test_the_page_opens_from_disk(page, folder):
    text = (folder / "index.html").read_text()
    assert "http" not in text and "<script" not in text
    assert page.pictures == ["b-soft-wet-b-shapes.png", "b-soft-wet-b-curves.png",
                             "solid-shapes.png", "solid-curves.png"]
    assert {path.name for path in folder.iterdir()} == {"index.html", "compare.json", *page.pictures}
    from matplotlib.image import imread

    for name in page.pictures:
        pixels = imread(folder / name)
        assert pixels.shape[1] == 1800 and pixels.shape[0] >= 400
        assert 0.03 < (pixels < 0.9).mean() < 0.6  # neither empty nor full


def test_a_scene_that_fails_says_so(tmp_path, entries):
    faults = {"fixed": {"velocity": 2}, "rtl": {}}
    failing = entries[1] | {"rtl_equals_fixed": False, "saturations": 2, "faults": faults}
    section = report.Section(failing, "", ["fact"], {"shapes": "a.png", "curves": "b.png"})
    report.write([section], tmp_path)
    page = Page((tmp_path / "index.html").read_text())
    assert page.figures["solid"]["rtl_equals_fixed"] is False
    assert "Fails: saturated: velocity." in page.text
    assert "Fails: the circuit's frames differ from the integer model's." in page.text
    assert "passes" not in page.text


@pytest.mark.parametrize("value, text", [
    (True, "yes"), (False, "no"), (0.0, "0"), (3.21e-6, "3.2e-6"), (0.25, "0.25"), (12.345, "12.3"), (7, "7"),
    (1234567, "1\u202f234\u202f567")])
def test_brief(value, text):
    assert brief(value) == text


@pytest.mark.parametrize("part, text", [(0.5041, "50.4 %"), (-1e-9, "0.0 %"), (1.0, "100.0 %")])
def test_percent(part, text):
    assert percent(part) == text


@pytest.mark.parametrize("name, text", [("plastic-3d", "plastic-3d"), ("Wet clay / 2", "wet-clay-2"), ("//", "scene")])
def test_slug(name, text):
    assert slug(name) == text


def test_the_shapes_are_those_of_float_and_circuit(monkeypatch):
    monkeypatch.setattr(machines, "circuit", in_place_of_the_circuit())
    comparison = compare(block("plastic", steps=(10, 5, 10), every=5))
    figure = shapes.draw(comparison)
    titles = [axes.get_title() for axes in figure.axes]
    assert titles == ["initial", "deformed: end of press, 0.002 s", "final: end of release, 0.005 s"]
    triangles = len(comparison.scene.mesh.cells)
    for axes, frame in zip(figure.axes, (0, 2, -1), strict=True):
        paths = [path.vertices[:3] for path in axes.collections[0].get_paths()]
        for run, drawn in ((comparison.float64, paths[:triangles]), (comparison.rtl, paths[triangles:])):
            np.testing.assert_allclose(drawn, run.trajectory.x[frame][comparison.scene.mesh.cells] * 1e3)


def test_a_single_phase_is_shown_in_its_middle():
    m = MESHES[2]
    scene = objects.scene(m, MATERIALS["plastic"], DT, [objects.phase(m, 8, objects.bottom(m), name="fall")], every=2)
    from sim.run import run

    trajectory = run(scene, "float").trajectory
    moving = replace(trajectory, v=trajectory.v + scene.size)
    assert shapes.chosen(scene, moving) == [
        (0, "initial"), (2, "deformed: during fall, 0.0008 s"), (4, "final: end of fall, 0.0016 s")]


@pytest.mark.parametrize("tetrahedra", [5, 6])
def test_the_surface_of_a_solid_looks_outwards(tetrahedra):
    m = mesh.box((4, 3, 5), (3.0, 2.0, 4.0), tetrahedra)
    faces = surface.surface(m)
    a, b, c = m.points[faces].transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    assert np.linalg.norm(normals, axis=1).sum() / 2 == pytest.approx(2 * (3 * 2 + 2 * 4 + 3 * 4))
    assert (np.einsum("ij,ij->i", normals, (a + b + c) / 3 - m.points.mean(axis=0)) > 0).all()
    seen, light = surface.visible(m.points, faces)
    assert len(seen) == len(faces) // 2 and (0 <= light).all() and (light <= 1).all()
    depth = m.points[seen].sum(axis=1) @ surface.VIEW
    assert (np.diff(depth) >= 0).all()


def test_the_picture_plane_is_square_to_the_view():
    axes = np.stack([surface.RIGHT, surface.UP, surface.VIEW])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert surface.UP[2] > 0
    assert np.linalg.norm(surface.LIGHT) == pytest.approx(1, abs=0.01)


def test_outlines():
    m = MESHES[2]
    border = surface.outline(m)
    assert np.linalg.norm(border[:, 1] - border[:, 0], axis=1).sum() == pytest.approx(2 * (0.1 + 0.08))
    box = surface.outline(MESHES[3])
    assert len(box) == 9
    assert sorted(np.linalg.norm(box[:, 1] - box[:, 0], axis=1)) == pytest.approx([0.06] * 3 + [0.08] * 3 + [0.1] * 3)
