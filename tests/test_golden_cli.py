"""``python -m golden mesh``: the figures it prints, the meshes it makes, the mistakes it refuses."""

import errno
import json
import os
import subprocess
import sys
from dataclasses import replace

import meshio
import numpy as np
import pytest
from scene_text import GEL, SCENE, TWO, changed, written

from environment import ROOT
from golden.__main__ import main
from golden.datapath.formats import Formats
from golden.mesh import files as meshfile
from golden.mesh import mesh
from golden.physics import stability
from golden.scene import capacity, inspection
from golden.scene import load as scene
from golden.support.errors import InputError

RING = ["ring", "--outer", "0.05", "--inner", "0.03", "--edge", "0.01"]
BOARDS = ["arty-a7-100", "tang-mega-138k-pro", "ulx3s-25f", "ulx3s-85f"]


def said(arguments, capsys):
    assert main(["mesh", *arguments]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    return out


def refused(arguments, message, capsys):
    assert main(["mesh", *arguments]) == 2
    assert tuple(capsys.readouterr()) == ("", f"error: {message}\n")


def test_the_figures_agree_with_the_mesh(capsys):
    found = json.loads(said([*RING, "--json"], capsys))
    ring = mesh.filled("ring", outer=0.05, inner=0.03, edge=0.01)
    sides = ring.points[ring.edges[:, 0]] - ring.points[ring.edges[:, 1]]
    length = np.hypot(*sides.T)
    assert (found["dim"], found["nodes"], found["edges"], found["elements"], found["parts"]) == (
        2,
        len(ring.points),
        len(ring.edges),
        len(ring.cells),
        1,
    )
    assert found["extent"] == {"min": ring.points.min(axis=0).tolist(), "max": ring.points.max(axis=0).tolist()}
    assert found["edge_length"]["min"] == pytest.approx(length.min()) and found["edge_length"]["max"] == length.max()
    assert length[(ring.edges == found["edge_length"]["shortest"]).all(axis=1)] == pytest.approx(length.min())
    worst = found["radius_ratio"]
    assert worst["min"] == ring.quality().min() == ring.quality()[worst["worst_element"]]
    assert worst["nodes"] == ring.cells[worst["worst_element"]].tolist()
    most = found["most_edges_at_a_node"]
    assert most["edges"] == (ring.edges == most["node"]).sum() and most["allowed"] == 31
    assert found["stable_dt"] is None
    assert list(found["boards"]) == BOARDS and all(board["fits"] for board in found["boards"].values())


def test_the_report_is_readable_as_text(capsys):
    out = said(RING, capsys).splitlines()
    ring = mesh.filled("ring", outer=0.05, inner=0.03, edge=0.01)
    assert out[0] == (f"ring: {len(ring.points)} nodes, {len(ring.edges)} edges, {len(ring.cells)} triangles, one part")
    assert [line.split()[0] for line in out[1:]] == ["extent", "edges", "worst", "edges", *BOARDS]
    assert max(map(len, out)) <= 120
    assert f"radius ratio {ring.quality().min():.3f}" in out[3]
    assert out[5].split() == ["arty-a7-100", "fits"]


def test_boards_that_are_too_small_say_by_how_much(capsys):
    out = said(["ball", "--radius", "0.05", "--edge", "0.012"], capsys)
    ball = mesh.filled("ball", radius=0.05, edge=0.012)
    assert f"ulx3s-25f          does not fit: {len(ball.points)} nodes of 256, {len(ball.edges)} edges of 512" in out
    assert "ulx3s-85f          fits" in out


def test_capacities_are_those_of_the_boards_circuits():
    from hw.boards import board as boards

    for board in capacity.load_capacities():
        parameters = boards.load(board.board).parameters()
        assert (board.nodes, board.edges) == (parameters.nodes, parameters.edges)
    assert [board.board for board in capacity.load_capacities()] == boards.names()


def test_a_boards_file_without_capacities_is_named(tmp_path):
    (tmp_path / "b.toml").write_text("[circuit]\nnodes = 3\n")
    with pytest.raises(InputError) as error:
        capacity.load_capacities(tmp_path)
    assert str(error.value) == (
        f"{tmp_path / 'b.toml'}: circuit.nodes and circuit.edges must be whole numbers in a TOML file ('edges')"
    )


def test_a_sum_of_forces_of_so_many_edges_cannot_overflow():
    formats = Formats()
    most, worst = capacity.max_edges_at_node(formats), -formats.force.raw_min
    assert most * worst <= formats.accumulator.raw_max < (most + 1) * worst


def test_stable_steps_are_those_of_the_whole_mesh_of_each_material(tmp_path, capsys):
    block = [
        "rectangle",
        "--nodes",
        "3",
        "3",
        "--size",
        "0.2",
        "0.1",
        "--scene",
        str(written(tmp_path, changed(SCENE, GEL, TWO))),
    ]
    found, text = json.loads(said([*block, "--json"], capsys)), said(block, capsys)
    clay = TWO.index("[materials.clay]")
    for material, table in (("gel", TWO[:clay]), ("clay", TWO[clay:])):
        free = changed(SCENE[: SCENE.index("[[phases]]")], GEL, table[: table.index("region")])
        alone = scene.load(written(tmp_path, free + "[[phases]]\nduration = 0.01\n"))
        assert found["stable_dt"][material] == pytest.approx(stability.largest_dt(alone)[0], rel=1e-6)
        assert f"stable dt          {found['stable_dt'][material]:.2g} s of {material}" in text


def test_a_material_that_nothing_limits_says_so():
    block = scene.load(ROOT / "scenes" / "viscoelastic.toml")
    slack = replace(block.materials[0], k=0.0, c1=0.0)
    found = inspection.inspect(block.mesh, replace(block, materials=(slack,)))
    assert found["stable_dt"] == {"jelly": None}
    json.dumps(found, allow_nan=False)
    lines = inspection.report_lines("block", found)
    assert any(line.split() == ["stable", "dt", "any", "of", "jelly"] for line in lines)


@pytest.mark.parametrize("suffix", ["vtu", "vtk", "msh"])
def test_a_written_mesh_is_read_again(suffix, tmp_path, capsys):
    out = tmp_path / f"ring.{suffix}"
    first = said([*RING, "--seed", "4", "--out", str(out)], capsys).splitlines()
    assert said([str(out)], capsys).splitlines()[1:] == first[1:]
    ring, again = mesh.filled("ring", outer=0.05, inner=0.03, edge=0.01, seed=4), mesh.read(out)
    assert np.array_equal(ring.points, again.points) and np.array_equal(ring.cells, again.cells)
    assert [path.name for path in tmp_path.iterdir()] == [out.name]


def test_a_file_in_another_unit(tmp_path, capsys):
    out = tmp_path / "ball.vtu"
    said(["ball", "--radius", "50", "--edge", "25", "--out", str(out)], capsys)
    found = json.loads(said([str(out), "--scale", "1e-3", "--json"], capsys))
    assert found["dim"] == 3 and found["measure"] == pytest.approx(
        mesh.filled("ball", radius=0.05, edge=0.025).measure().sum(), rel=1e-9
    )


def test_parts_that_no_edge_joins_are_counted(tmp_path, capsys):
    apart = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    meshio.write_points_cells(
        tmp_path / "two.vtu",
        np.concatenate([apart, apart + [2, 0, 0]]).astype(float),
        [("triangle", [[0, 1, 2], [3, 4, 5]])],
    )
    assert "2 triangles, 2 parts that no edge joins\n" in said([str(tmp_path / "two.vtu")], capsys)


def test_a_surface_is_refused_with_what_to_do(tmp_path, capsys):
    path = tmp_path / "skin.stl"
    meshio.write_points_cells(
        path,
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float),
        [("triangle", [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])],
    )
    refused(
        [str(path)],
        f"{path}: file must hold triangles in one plane of constant z, not a surface in space "
        f"(in {path}): make the mesh flat, or fill the surface with tetrahedra",
        capsys,
    )


GIVEN = "must not be given with a"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "the following arguments are required: FILE|KIND (see python -m golden mesh --help)"),
        (["ring"], "--outer must be given"),
        (["ring", "--outer", "0.05", "--inner", "0.03"], "--edge must be given"),
        ([*RING, "--height", "1"], f"--height {GIVEN} ring, which has --outer, --inner, --edge, --seed"),
        (["x.msh", "--edge", "1"], f"--edge {GIVEN} file, which has --scale"),
        ([*RING[:-1], "-1"], "--edge must be a number above 0, not -1.0"),
        ([*RING[:-1], "nan"], "--edge must be a finite number, not nan"),
        ([*RING[:-1], "wide"], "argument --edge: must be a number, not 'wide' (see python -m golden mesh --help)"),
        (
            [*RING, "--seed", "1.5"],
            "argument --seed: must be a whole number, not '1.5' (see python -m golden mesh --help)",
        ),
        ([*RING, "--seed", "-1"], "--seed must be a whole number of at least 0, not -1"),
        ([*RING[:-1], "0.03"], "--edge must be at most 0.02, the width, not 0.03"),
        (["box", "--nodes", "3", "--size", "1"], "--nodes must be 3 whole numbers of at least 2, not [3]"),
        (["absent.msh"], "absent.msh: file must be an existing mesh file, not absent.msh"),
        ([*RING, "--out", "ring.stl"], "--out must end in .vtu, .vtk, .msh, not 'ring.stl'"),
        ([*RING, "--out", "absent/ring.vtu"], "--out must be in a folder that is there, not absent"),
        (
            [*RING, "--scene", "absent.toml"],
            "absent.toml: the scene must be a readable file: No such file or directory",
        ),
        (
            [*RING, "--scene", str(ROOT / "scenes" / "plastic-3d.toml")],
            "--scene must be of an object in 2 dimensions, as the mesh is, not 3",
        ),
    ],
)
def test_mistakes_in_the_arguments_are_one_line(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    refused(arguments, message, capsys)
    assert not list(tmp_path.iterdir())


def test_a_file_that_is_there_stays(tmp_path, capsys):
    out = tmp_path / "ring.vtu"
    out.write_text("mine")
    refused(
        [*RING, "--out", str(out)],
        f"--out must be a new file, not {out}, which is there: choose another, or add --force to replace it",
        capsys,
    )
    assert out.read_text() == "mine"
    said([*RING, "--out", str(out), "--force"], capsys)
    assert len(mesh.read(out).points) > 50
    (tmp_path / "folder.vtu").mkdir()
    refused(
        [*RING, "--out", str(tmp_path / "folder.vtu"), "--force"],
        f"--out must be a new file, not {tmp_path / 'folder.vtu'}, which is there: choose another",
        capsys,
    )


def test_a_file_that_cannot_be_written(tmp_path, capsys, monkeypatch):
    def full(*args):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(meshfile, "write", full)
    out = tmp_path / "ring.vtu"
    refused(
        [*RING, "--out", str(out)],
        f"--out must be a file that can be written, not {out}: No space left on device",
        capsys,
    )


def test_a_status_line_is_shown_meanwhile(monkeypatch, capsys):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert main(["mesh", *RING]) == 0
    out, err = capsys.readouterr()
    assert err == "ring ...\r        \r" and out.startswith("ring: ")


def test_the_command_itself_runs():
    done = subprocess.run([sys.executable, "-m", "golden", "mesh", *RING], cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "") and done.stdout.startswith("ring: ")
