"""sim.results.export: a time series for ParaView holds the run's own numbers."""

from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
from scene_text import GEL, SCENE, TWO, changed, written

from environment import ROOT
from golden.physics.model import Model
from sim.__main__ import main
from sim.results import run_folder
from sim.support.folder import MARK

BALL = changed(
    changed(
        changed((ROOT / "scenes" / "ball.toml").read_text(), "duration = 0.085", "duration = 0.005"),
        "duration = 0.15",
        "duration = 0.005",
    ),
    "count = 100",
    "every = 13",
)


@pytest.fixture(params=["2-D", "3-D"])
def run(request, tmp_path):
    """Return the folder of a run on the integer model, which has no reaction in its first frame."""
    text = changed(SCENE, GEL, TWO) if request.param == "2-D" else BALL
    assert main(["run", str(written(tmp_path, text)), "--backend", "fixed", "--out", str(tmp_path / "run")]) == 0
    return tmp_path / "run"


def test_every_frame_has_a_file(run, capsys):
    capsys.readouterr()
    assert main(["export", str(run), "--vtu"]) == 0
    scene, _, kept = run_folder.load(run)
    folder = run / "vtu"
    out, err = capsys.readouterr()
    assert (out, err) == (f"{scene.name}: {len(kept.t)} frames in {folder / 'run.pvd'}\n", "")
    root = ElementTree.parse(folder / "run.pvd").getroot()
    assert root.tag == "VTKFile" and root.get("type") == "Collection"
    sets = root.findall("./Collection/DataSet")
    assert [float(frame.get("timestep")) for frame in sets] == kept.t.tolist()
    names = [frame.get("file") for frame in sets]
    assert names == [f"frame-{n:04}.vtu" for n in range(len(kept.t))]
    assert {path.name for path in folder.iterdir()} == {MARK, "run.pvd", *names}


def test_a_file_holds_the_runs_frame(run):
    main(["export", str(run), "--vtu"])
    scene, _, kept = run_folder.load(run)
    dim, element = scene.dim, {2: "triangle", 3: "tetra"}[scene.dim]
    model, last = Model(scene), len(kept.t) - 1
    for n in (0, last // 2, last):
        frame = meshio.read(run / "vtu" / f"frame-{n:04}.vtu")
        assert np.array_equal(frame.points[:, :dim], kept.x[n]) and not frame.points[:, dim:].any()
        assert [block.type for block in frame.cells] == ["line", element]
        assert np.array_equal(frame.cells[0].data, scene.mesh.edges)
        assert np.array_equal(frame.cells[1].data, scene.mesh.cells)
        vectors = {"displacement": kept.x[n] - kept.x[0], "velocity": kept.v[n], "reaction": kept.reaction[n]}
        assert frame.point_data.keys() == vectors.keys()
        for name, values in vectors.items():
            assert frame.point_data[name].shape == (len(kept.x[n]), 3)
            assert np.array_equal(frame.point_data[name][:, :dim], values, equal_nan=True), name
        ratio, force = frame.cell_data["ratio"], frame.cell_data["force"]
        assert np.array_equal(ratio[0], kept.a[n])
        # the forces along the edges are those that move the nodes
        sums, _ = model.edges(kept.x[n], kept.v[n], kept.a[n])
        i, j = scene.mesh.edges.T
        u = kept.x[n][j] - kept.x[n][i]
        push = (force[0] / np.linalg.norm(u, axis=1))[:, None] * u
        again = np.zeros_like(sums)
        np.add.at(again, j, push)
        np.add.at(again, i, -push)
        np.testing.assert_allclose(again, sums, rtol=1e-9, atol=1e-12 * max(1, np.abs(sums).max()))
        around = [
            [k for k, edge in enumerate(scene.mesh.edges.tolist()) if set(edge) <= set(cell)]
            for cell in scene.mesh.cells[:20].tolist()
        ]
        for name in ("ratio", "force"):
            on_edges, on_elements = frame.cell_data[name]
            np.testing.assert_allclose(on_elements[:20], on_edges[around].mean(axis=1), rtol=1e-12, atol=1e-15)
    assert np.abs(force[0]).max() > 0


def test_a_pressed_edge_pushes(tmp_path):
    """The upright edges of an object pressed from above push their ends apart: their force is above 0."""
    main(["run", str(written(tmp_path, SCENE)), "--backend", "float", "--out", str(tmp_path / "run")])
    main(["export", str(tmp_path / "run"), "--vtu"])
    scene, _, _ = run_folder.load(tmp_path / "run")
    pressed = int(np.searchsorted(scene.frames, scene.phases[0].steps))
    frame = meshio.read(tmp_path / "run" / "vtu" / f"frame-{pressed:04}.vtu")
    upright = np.ptp(scene.mesh.points[scene.mesh.edges][:, :, 0], axis=1) == 0
    assert upright.sum() == 6 and frame.cell_data["force"][0][upright].mean() > 0


def test_another_folder_can_be_chosen(run, tmp_path, capsys):
    out = tmp_path / "elsewhere"
    assert main(["export", str(run), "--vtu", "--out", str(out)]) == 0
    assert (out / "run.pvd").exists() and not (run / "vtu").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["RUN"], "the following arguments are required: --vtu (see python -m sim export --help)"),
        (["absent", "--vtu"], "RUN must be a folder that `python -m sim run` left, not absent: it has no summary.json"),
        (
            ["RUN", "--vtu", "--out", "theirs"],
            "--out must be a new folder or one of earlier results, not theirs, which "
            "holds other files: choose another, or add --force to write into it all the same",
        ),
    ],
)
def test_mistakes_in_the_arguments_are_one_line(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    main(["run", str(written(tmp_path)), "--backend", "float", "--out", "RUN"])
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs" / "run.pvd").write_text("mine")
    capsys.readouterr()
    assert main(["export", *arguments]) == 2
    assert tuple(capsys.readouterr()) == ("", f"error: {message}\n")
    assert (tmp_path / "theirs" / "run.pvd").read_text() == "mine" and not (tmp_path / "RUN" / "vtu").exists()
