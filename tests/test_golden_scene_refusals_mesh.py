"""Mistakes in a scene's mesh, each in one line with the path of the key."""

import numpy as np
import pytest
from scene_text import MESH, SCENE, changed, refusal, written

from golden.scene.load import load

REFUSED = [
    (MESH, "mesh = 3", "mesh must be a table, not 3"),
    (
        'kind = "rectangle"',
        'kind = "cone"',
        "mesh.kind must be one of rectangle, box, file, disc, ring, cylinder, ball, beam, irregular, not 'cone'",
    ),
    ('kind = "rectangle"', "kind = 1", "mesh.kind must be text, not 1"),
    ('kind = "rectangle", ', "", "mesh.kind must be given"),
    ("nodes = [3, 3],", "", "mesh.nodes must be given"),
    (
        "nodes = [3, 3],",
        "nodes = [3, 3], tetrahedra = 5,",
        "mesh.tetrahedra must not be there: the keys known here are kind, nodes, size",
    ),
    ("nodes = [3, 3],", "nodes = [3, 3.5],", "mesh.nodes[1] must be a whole number, not 3.5"),
    ("nodes = [3, 3],", "nodes = [3, 1],", "mesh.nodes must be 2 whole numbers of at least 2, not [3, 1]"),
    ("nodes = [3, 3],", "nodes = [3, 3, 3],", "mesh.nodes must be 2 whole numbers of at least 2, not [3, 3, 3]"),
    ("size = [0.2, 0.1]", "size = [0.2, -0.1]", "mesh.size must be 2 finite numbers above 0, not [0.2, -0.1]"),
    (
        MESH,
        'mesh = { kind = "box", nodes = [2, 2, 2], size = [1, 1, 1], tetrahedra = 7 }',
        "mesh.tetrahedra must be 5 or 6, not 7",
    ),
    (
        MESH,
        'mesh = { kind = "file", file = "part.msh", scale = 0 }',
        "mesh.scale must be a finite number above 0, not 0.0",
    ),
    (
        MESH,
        'mesh = { kind = "ring", outer = 0.05, inner = 0.06, edge = 0.01 }',
        "mesh.inner must be below outer = 0.05, not 0.06",
    ),
    (MESH, 'mesh = { kind = "ring", outer = 0.05, inner = 0.03 }', "mesh.edge must be given"),
    (
        MESH,
        'mesh = { kind = "disc", radius = 0.05, edge = 0.01, seed = -1 }',
        "mesh.seed must be a whole number of at least 0, not -1",
    ),
    (
        MESH,
        'mesh = { kind = "ball", radius = 0.05, edge = 0.01, height = 1 }',
        "mesh.height must not be there: the keys known here are kind, radius, edge, seed",
    ),
    (MESH, 'mesh = { kind = "beam", size = [1], edge = 0.01 }', "mesh.size must be 2 or 3 numbers above 0, not [1.0]"),
]


@pytest.mark.parametrize("old, new, message", REFUSED)
def test_wrong_meshes_and_masses_are_refused(tmp_path, old, new, message):
    assert refusal(written(tmp_path, changed(SCENE, old, new))) == message


def part(folder, points, cells):
    """Write a mesh file, and return the scene's line that names it."""
    import meshio

    meshio.write_points_cells(folder / "part.vtk", np.array(points, dtype=float), [("triangle", cells)])
    return 'mesh = { kind = "file", file = "part.vtk" }'


SQUARE = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]


@pytest.mark.parametrize(
    "points, cells, message",
    [
        (
            SQUARE,
            [[0, 1, 2]],
            "mesh.points must all belong to a cell, but point 3 does not: remove it (1 of 4 are isolated)",
        ),
        (
            SQUARE + [[1, 1, 0]],
            [[0, 1, 2], [1, 3, 2], [1, 4, 2]],
            "mesh.points must all differ, but 3 and 4 are at the same place: merge them "
            "(an edge of zero length has no direction)",
        ),
        (
            SQUARE,
            [[0, 1, 2], [1, 3, 2], [2, 3, 1]],
            "mesh.cells must all differ, but cells 1 and 2 have the same nodes: remove one",
        ),
    ],
)
def test_invalid_mesh_files_are_refused(tmp_path, points, cells, message):
    text = changed(SCENE, MESH, part(tmp_path, points, cells))
    assert refusal(written(tmp_path, text)) == message


def test_a_missing_mesh_file_is_refused(tmp_path):
    text = changed(SCENE, MESH, 'mesh = { kind = "file", file = "part.vtk" }')
    assert refusal(written(tmp_path, text)) == f"mesh.file must be an existing mesh file, not {tmp_path / 'part.vtk'}"


TWO_PARTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 0, 0], [6, 0, 0], [5, 1, 0]]


@pytest.mark.parametrize(
    "fixed, message",
    [
        ("[0, 3]", None),
        (
            "[0]",
            "phases[0] must fix or drive a node of each of the 2 parts of the mesh that no edge joins, "
            "not leave the part of node 3 free",
        ),
    ],
)
def test_every_part_must_be_held(tmp_path, fixed, message):
    mesh = part(tmp_path, TWO_PARTS, [[0, 1, 2], [3, 4, 5]])
    text = changed(SCENE[: SCENE.index("[[phases]]")], MESH, mesh)
    path = written(tmp_path, f"{text}[[phases]]\nduration = 0.01\nfixed = [{{ nodes = {fixed} }}]\n")
    if message:
        assert refusal(path) == message
    else:
        assert load(path).mesh.components()[0] == 2


def test_one_part_may_be_free(tmp_path):
    text = SCENE[: SCENE.index("[[phases]]")] + "[[phases]]\nduration = 0.01\n"
    assert not load(written(tmp_path, text)).phases[0].held.any()
