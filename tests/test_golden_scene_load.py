"""`golden.scene.load`: a scene file and the scene it becomes."""

import numpy as np
import pytest
from scene_text import BOTTOM, GEL, MESH, SCENE, TWO, changed, written

from golden.mesh import mesh
from golden.scene.load import load


def test_everything_is_resolved(tmp_path):
    scene = load(written(tmp_path))
    assert (scene.name, scene.description, scene.path.name) == ("block", "", "scene.toml")
    assert (scene.dim, scene.dt, scene.steps, scene.force_dependent) == (2, 1e-4, 150, False)
    np.testing.assert_array_equal(scene.gravity, [0, -9.81])
    assert scene.mass.sum() == pytest.approx(2, rel=1e-15)
    press, hold = scene.phases
    assert (press.name, press.steps, hold.name, hold.steps) == ("press", 100, "phase 2", 50)
    np.testing.assert_array_equal(np.flatnonzero(press.fixed), [0, 1, 2])
    np.testing.assert_array_equal(np.flatnonzero(press.driven), [6, 7, 8])
    np.testing.assert_array_equal(press.velocity, [[0, 0]] * 6 + [[0, -0.5]] * 3)
    np.testing.assert_array_equal(press.load[3:6], [[0, 2], [1, 2], [0, 2]])  # loads on the same node add up
    assert not press.load[[0, 1, 2, 6, 7, 8]].any()
    assert not hold.held.any() and not hold.load.any() and not hold.velocity.any()


def test_what_is_left_out_has_a_default(tmp_path):
    text = changed(
        changed(changed(SCENE, 'name = "block"\n', ""), "gravity = [0, -9.81]\n", ""), "frames = { every = 30 }\n", ""
    )
    scene = load(written(tmp_path, text))
    assert scene.name == "scene" and not scene.gravity.any()
    assert len(scene.frames) == 101


@pytest.mark.parametrize(
    "frames, expected",
    [
        ("every = 30", [0, 30, 60, 90, 100, 120, 150]),
        ("every = 1000", [0, 100, 150]),
        ("every = 1_000_000_000_000_000_000_000", [0, 100, 150]),
        ("count = 3", [0, 50, 100, 150]),
        ("count = 4", [0, 38, 75, 100, 112, 150]),
        ("count = 1_000_000_000_000_000_000_000", list(range(151))),
    ],
)
def test_frames_hold_the_ends_of_phases(tmp_path, frames, expected):
    scene = load(written(tmp_path, changed(SCENE, "every = 30", frames)))
    assert scene.frames.tolist() == expected


@pytest.mark.parametrize("duration, steps", [("0.01", 100), ("0.01004", 100), ("0.01006", 101), ("6e-5", 1)])
def test_durations_are_rounded_to_steps(tmp_path, duration, steps):
    scene = load(written(tmp_path, changed(SCENE, "duration = 0.01\n", f"duration = {duration}\n")))
    assert scene.phases[0].steps == steps


@pytest.mark.parametrize(
    "dim, kind, density, total",
    [
        (2, 'kind = "rectangle", nodes = [3, 3], size = [0.2, 0.1]', 50.0, 1.0),
        (3, 'kind = "box", nodes = [3, 3, 2], size = [0.2, 0.1, 0.1], tetrahedra = 6', 500.0, 1.0),
    ],
)
def test_density_and_total_agree(tmp_path, dim, kind, density, total):
    zeros = [0.0] * dim
    text = (
        f"dt = 1e-4\nmesh = {{ {kind} }}\nmass = {{ MASS }}\n{GEL}[[phases]]\nduration = 0.01\n"
        f"driven = [{{ nodes = [0], velocity = {zeros} }}]\n"
    )
    by_density = load(written(tmp_path, changed(text, "MASS", f"density = {density}")))
    by_total = load(written(tmp_path, changed(text, "MASS", f"total = {total}")))
    assert by_density.dim == dim
    np.testing.assert_allclose(by_density.mass, by_total.mass, rtol=1e-14)


def test_mesh_file_lies_beside_the_scene(tmp_path):
    import meshio

    points = np.array([[0, 0], [100, 0], [0, 100], [100, 100]], dtype=float)
    meshio.write_points_cells(
        tmp_path / "plate.vtk", np.column_stack([points, [0] * 4]), [("triangle", [[0, 1, 2], [1, 3, 2]])]
    )
    text = changed(SCENE, MESH, 'mesh = { kind = "file", file = "plate.vtk", scale = 1e-3 }')
    start = text.index("[[phases]]")
    scene = load(written(tmp_path, text[:start] + "[[phases]]\nduration = 0.01\n"))
    np.testing.assert_allclose(scene.mesh.points, points * 1e-3, rtol=1e-15)


def test_a_shared_edge_has_the_first_material_of_its_elements(tmp_path):
    both = load(written(tmp_path, changed(SCENE, GEL, TWO)))
    assert [material.name for material in both.materials] == ["gel", "clay"] and both.force_dependent
    ends = both.mesh.points[both.mesh.edges][:, :, 0]
    np.testing.assert_array_equal(both.edge_material, ends.max(axis=1) > 0.1 + 1e-9)  # the seam is gel
    first, second = TWO.split("[materials.clay]")
    swapped = load(written(tmp_path, changed(SCENE, GEL, f"[materials.clay]{second}\n{first}")))
    assert [material.name for material in swapped.materials] == ["clay", "gel"]
    np.testing.assert_array_equal(swapped.edge_material, ends.min(axis=1) < 0.1 - 1e-9)  # the seam is clay


def test_irregular_meshes_are_made_by_kind(tmp_path):
    text = changed(SCENE, MESH, 'mesh = { kind = "ring", outer = 0.05, inner = 0.03, edge = 0.01, seed = 3 }')
    scene = load(written(tmp_path, text[: text.index("[[phases]]")] + "[[phases]]\nduration = 0.01\n"))
    ring = mesh.filled("ring", outer=0.05, inner=0.03, edge=0.01, seed=3)
    np.testing.assert_array_equal(scene.mesh.points, ring.points)
    np.testing.assert_array_equal(scene.mesh.cells, ring.cells)


def test_one_material_has_what_the_others_leave(tmp_path):
    both = load(written(tmp_path, changed(SCENE, GEL, TWO)))
    for region in (
        "region = { box = { min = [0, 0], max = [0.1, 0.1] } }",
        "region = { box = { min = [0.1, 0], max = [0.2, 0.1] } }",
    ):
        rest = load(written(tmp_path, changed(SCENE, GEL, changed(TWO, region, ""))))
        np.testing.assert_array_equal(rest.edge_material, both.edge_material)


def test_a_list_of_nodes_selects_the_elements_within_it(tmp_path):
    """An element belongs to a list of nodes if all of its nodes are listed."""
    left, right = "[0, 1, 3, 4, 6, 7]", "[1, 2, 4, 5, 7, 8]"
    text = changed(
        changed(TWO, "box = { min = [0, 0], max = [0.1, 0.1] }", f"nodes = {left}"),
        "box = { min = [0.1, 0], max = [0.2, 0.1] }",
        f"nodes = {right}",
    )
    by_nodes = load(written(tmp_path, changed(SCENE, GEL, text)))
    by_box = load(written(tmp_path, changed(SCENE, GEL, TWO)))
    np.testing.assert_array_equal(by_nodes.edge_material, by_box.edge_material)


@pytest.mark.parametrize(
    "region",
    [
        BOTTOM,
        '{ plane = { axis = "y", at = 0.01, tolerance = 0.02 } }',
        "{ box = { min = [-1, -1], max = [1, 0.0] } }",
        "{ ball = { center = [0.1, -0.4], radius = 0.415 } }",
        "{ nodes = [2, 0, 1, 1] }",
    ],
)
def test_different_regions_select_the_same_nodes(tmp_path, region):
    scene = load(written(tmp_path, changed(SCENE, BOTTOM, region)))
    np.testing.assert_array_equal(np.flatnonzero(scene.phases[0].fixed), [0, 1, 2])
