"""sim.figures: the files, their scales and colours, and the command that makes them."""

import json
import xml.etree.ElementTree as ElementTree

import matplotlib
import numpy as np
import pytest
from figure_runs import pair
from matplotlib.collections import PolyCollection
from PIL import Image

from golden.mesh import mesh
from sim.__main__ import main
from sim.figures import body, catalogue, film, gravity, make, paper, pressed, reading, solid
from sim.figures.catalogue import FIGURES
from sim.report.surface import surface
from sim.support import batch, terminal
from sim.support.folder import MARK

SUFFIXES = "png", "svg", "gif"


def pairs(name):
    return [pair(scene) for scene in FIGURES[name].scenes]


def drawn(name, out):
    return make.draw(name, {each.scene.name: each for each in pairs(name)}, out)


@pytest.fixture
def short(monkeypatch):
    """Make films of three pictures."""
    monkeypatch.setattr(film, "FRAMES", 3)


@pytest.fixture
def one_process(monkeypatch):
    monkeypatch.setattr(batch, "cores", lambda: 1)


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_has_its_files(name, short, tmp_path):
    entry = drawn(name, tmp_path)
    assert entry["files"] == [f"{name}.{suffix}" for suffix in SUFFIXES]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(entry["files"])
    with Image.open(tmp_path / f"{name}.png") as png:
        assert png.width == round(paper.WIDTH * make.DPI) and png.height < 1.1 * png.width
    tree = ElementTree.parse(tmp_path / f"{name}.svg")
    assert tree.getroot().tag == "{http://www.w3.org/2000/svg}svg"
    with Image.open(tmp_path / f"{name}.gif") as gif:
        assert gif.n_frames == 3 and gif.info["loop"] == 0
        pictures = []
        for frame in range(3):
            gif.seek(frame)
            pictures.append((np.array(gif.convert("RGB")), gif.info["duration"]))
    assert [duration for _, duration in pictures] == [film.EVERY, film.EVERY, film.PAUSE]
    assert not any(np.array_equal(pictures[n][0], pictures[n + 1][0]) for n in range(2))
    assert (pictures[0][0][:3] == 255).all()  # white around


def test_the_same_runs_give_the_same_bytes(short, tmp_path):
    for again in ("one", "two"):
        (tmp_path / again).mkdir()
        drawn("gravity", tmp_path / again)
    for suffix in SUFFIXES:
        one, two = ((tmp_path / again / f"gravity.{suffix}").read_bytes() for again in ("one", "two"))
        assert one == two
    assert b"<dc:date>" not in one and b"date" not in (tmp_path / "one" / "gravity.svg").read_bytes().lower()


def inches_per_mm(figure):
    """Return the scale of every drawing of an object in a figure, in both directions."""
    size = figure.get_size_inches()
    for axes in figure.axes:
        if any(isinstance(each, PolyCollection) and each.get_array() is not None for each in axes.collections):
            box = axes.get_position()
            yield box.width * size[0] / np.ptp(axes.get_xlim()), box.height * size[1] / np.ptp(axes.get_ylim())


@pytest.mark.parametrize(
    "names, draw, scale, drawings",
    [
        (("figure-3", "figure-4", "figure-5"), pressed.draw, paper.SCALE, 9),
        (("figure-6",), solid.draw, solid.SCALE, 9),
        (("gravity",), gravity.draw, gravity.SCALE, 6),
    ],
)
def test_one_scale_in_all_drawings(names, draw, scale, drawings):
    scales = [each for name in names for each in inches_per_mm(draw(pairs(name)))]
    np.testing.assert_allclose(scales, np.full((drawings, 2), scale), rtol=1e-9)


@pytest.mark.parametrize(
    "names, draw, shade",
    [
        (("figure-3", "figure-4", "figure-5"), pressed.draw, body.STRAIN),
        (("figure-6",), solid.draw, body.STRAIN),
        (("gravity",), gravity.draw, body.RATIO),
    ],
)
def test_one_colour_bar_that_holds_what_is_drawn(names, draw, shade):
    for name in names:
        figure = draw(pairs(name))
        painted = [
            each
            for axes in figure.axes
            for each in axes.collections
            if isinstance(each, PolyCollection) and each.get_array() is not None
        ]
        values = np.concatenate([each.get_array() for each in painted])
        assert all(each.norm is shade.norm and each.cmap is body.COLOURS for each in painted)
        assert (shade.norm.vmin <= values.min() and values.max() <= shade.norm.vmax) == (shade.extend == "neither")
        assert np.mean((values < shade.norm.vmin - 0.005) | (values > shade.norm.vmax)) < 0.02
        assert shade.label in [axes.get_ylabel() for axes in figure.axes]


def test_the_colours_get_darker_all_the_way():
    """Darkness alone must tell them apart, in grey and for colour-blind readers."""
    light = body.COLOURS(np.linspace(0, 1, 200))[:, :3] @ (0.2126, 0.7152, 0.0722)
    assert (np.diff(light) < 0.001).all() and light[0] > 0.95 and 0.1 < light[-1] < 0.3


def test_the_sides_of_faces_are_the_mesh_s_edges():
    for block in (mesh.rectangle((4, 3), (1, 1)), mesh.box((3, 3, 3), (1, 1, 1))):
        faces = surface(block)
        for n, corners in ((0, (0, 1)), (1, (1, 2)), (2, (2, 0))):
            expected = np.sort(faces[:, corners], axis=1)
            np.testing.assert_array_equal(block.edges[body.sides(block, faces)[:, n]], expected)


def test_the_border_of_a_rectangle():
    block = mesh.rectangle((5, 4), (1, 1))
    outside = ((block.points == 0) | (block.points == 1)).any(axis=1)
    np.testing.assert_array_equal(body.border(block), np.flatnonzero(outside))


def test_strain_is_that_of_the_circuits_edges():
    block = pair("plastic")
    x, edges = block.circuit.trajectory.x, block.scene.mesh.edges
    length = [np.hypot(*(shape[edges[:, 1]] - shape[edges[:, 0]]).T) for shape in (x[0], x[-1])]
    strain = body.strain(block.circuit.trajectory, len(x) - 1)
    np.testing.assert_allclose(strain, 100 * (length[1] - length[0]) / length[0], atol=1e-10)
    figure = matplotlib.figure.Figure()
    axes = figure.add_subplot()
    body.Body(axes, block, body.STRAIN, len(x) - 1)
    painted = axes.collections[0].get_array()
    rms = np.sqrt((strain[body.sides(block.scene.mesh, block.scene.mesh.cells)] ** 2).mean(axis=1))
    np.testing.assert_allclose(painted, rms)


def test_figures_are_chosen_in_their_order():
    assert catalogue.chosen([]) == list(FIGURES)
    assert catalogue.chosen(["gravity", "figure-3", "gravity"]) == ["figure-3", "gravity"]


def test_the_command_draws_the_figures_and_prints_their_readings(short, one_process, tmp_path, capsys):
    out = tmp_path / "figures"
    assert main(["figures", "figure-4", "--out", str(out)]) == 0
    said, err = capsys.readouterr()
    assert err == "" and str(out / "figures.json") in said
    assert [line.split()[:2] for line in said.splitlines()[1:4]] == [
        ["plastic", "bounce-back"],
        ["plastic", "residual"],
        ["plastic", "max"],
    ]
    assert all(line.endswith("passes") for line in said.splitlines()[1:4])
    assert {path.name for path in out.iterdir()} == {MARK, "figures.json"} | {f"figure-4.{s}" for s in SUFFIXES}
    entry = json.loads((out / "figures.json").read_text())["figure-4"]
    assert entry["backend"] == "fixed" and entry["saturated"] == {}
    expected = [*reading.press(pair("plastic")), reading.apart(pair("plastic"))]
    assert entry["readings"] == [read.entry() for read in expected]
    curves = entry["curves"]["plastic"]
    np.testing.assert_array_equal(curves["t"], pair("plastic").circuit.trajectory.t)
    assert curves["deformation"]["circuit"][-1] == pytest.approx(expected[1].circuit, abs=1e-15)
    assert curves["force"]["circuit"][0] is None and curves["force"]["float64"][0] is not None


def test_other_figures_numbers_stay(short, one_process, tmp_path, capsys):
    (tmp_path / MARK).touch()
    (tmp_path / "figures.json").write_text('{"figure-1": {"kept": true}, "figure-4": {"kept": false}}')
    assert main(["figures", "figure-4", "--json", "--out", str(tmp_path)]) == 0
    written = (tmp_path / "figures.json").read_text()
    assert capsys.readouterr().out == written
    assert json.loads(written)["figure-1"] == {"kept": True} and "readings" in json.loads(written)["figure-4"]


def test_a_missed_bound_exits_1(short, one_process, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(reading, "BOUND", {False: 1e-12, True: 1e-12})
    assert main(["figures", "figure-4", "--out", str(tmp_path / "out")]) == 1
    said, err = capsys.readouterr()
    assert err == "error: plastic: max dx must be within 1e-12 of float64, not 1.71e-07 off\n"
    assert "FAILS" in said


def test_progress_is_shown_on_a_terminal(short, one_process, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(terminal.sys.stderr, "isatty", lambda: True, raising=False)
    assert main(["figures", "figure-4", "--out", str(tmp_path / "out")]) == 0
    assert "figure-4" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments, message",
    [
        (["figure-2"], "NAME must be one of figure-1, figure-3, figure-4, figure-5, figure-6, gravity, not 'figure-2'"),
        (
            ["--backend", "float"],
            "argument --backend: invalid choice: 'float' (choose from 'fixed', 'rtl') "
            "(see python -m sim figures --help)",
        ),
    ],
)
def test_mistakes_are_refused_before_anything_runs(arguments, message, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["figures", *arguments, "--out", str(out)]) == 2
    assert tuple(capsys.readouterr()) == ("", f"error: {message}\n")
    assert not out.exists()


def test_other_peoples_folders_are_left_alone(tmp_path, capsys):
    (tmp_path / "figure-4.png").write_text("mine")
    assert main(["figures", "figure-4", "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err.startswith("error: --out must be a new folder or one of earlier results, not ")
    assert [path.name for path in tmp_path.iterdir()] == ["figure-4.png"]


@pytest.mark.parametrize("text", ["{", "[]"])
def test_numbers_that_cannot_be_read_are_not_overwritten(text, tmp_path, capsys):
    (tmp_path / MARK).touch()
    (tmp_path / "figures.json").write_text(text)
    assert main(["figures", "figure-4", "--out", str(tmp_path)]) == 2
    err = capsys.readouterr().err
    assert err == (
        f"error: {tmp_path / 'figures.json'} must be what `python -m sim figures` left, not something else: remove it\n"
    )
    assert (tmp_path / "figures.json").read_text() == text


@pytest.mark.campaign
def test_films_are_small(tmp_path):
    for name in FIGURES:
        drawn(name, tmp_path)
        assert (tmp_path / f"{name}.gif").stat().st_size < 1.5e6


@pytest.mark.campaign
def test_the_simulated_circuit_draws_the_same(tmp_path):
    """Figure 1 is the test, because it has the single edges, which no shipped scene has."""
    circuit = make.compute(make.scenes(["figure-1"]), "rtl")
    for name, run in circuit.items():
        assert run.circuit.raw.same(pair(name).circuit.raw)
