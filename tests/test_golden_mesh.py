"""Grids, and the checks that every mesh passes."""

from itertools import combinations

import numpy as np
import pytest

from golden.mesh import mesh
from golden.support.errors import InputError

TRIANGLES = np.array([[0, 1, 2], [1, 3, 2]])
SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [2.0, 1.0]])
CORNER = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])


def faces(cells):
    """Return each face of the cells, and the number of cells that have it."""
    corners = combinations(range(cells.shape[1]), cells.shape[1] - 1)
    found = np.sort(np.concatenate([cells[:, chosen] for chosen in corners]), axis=1)
    return np.unique(found, axis=0, return_counts=True)


def test_rectangle_is_the_grid_of_the_design():
    grid = mesh.rectangle((9, 9), (0.2, 0.1))
    assert (grid.points.shape, grid.cells.shape, grid.edges.shape) == ((81, 2), (128, 3), (208, 2))
    assert np.array_equal(grid.points[[0, 1, 9, 80]], [[0, 0], [0.025, 0], [0, 0.0125], [0.2, 0.1]])
    assert (grid.dim, grid.size) == (2, 0.2)
    assert grid.measure() == pytest.approx(np.full(128, 0.02 / 128), rel=1e-12)


def test_rectangle_is_its_own_mirror_image():
    """An even number of cells: pressing it from above must not push it sideways."""
    nodes = np.arange(25).reshape(5, 5)
    edges = mesh.rectangle((5, 5), (1.0, 1.0)).edges
    for mirrored in (nodes[:, ::-1].ravel(), nodes[::-1].ravel()):
        assert np.array_equal(np.unique(np.sort(mirrored[edges], axis=1), axis=0), edges)


@pytest.mark.parametrize(("tetrahedra", "edges"), [(5, 540), (6, 604)])
def test_box_fills_its_volume_with_matching_faces(tetrahedra, edges):
    grid = mesh.box((5, 5, 5), (1.0, 2.0, 0.5), tetrahedra)
    assert (len(grid.points), len(grid.cells), len(grid.edges)) == (125, 64 * tetrahedra, edges)
    assert np.array_equal(grid.points[[1, 5, 25]], [[0.25, 0, 0], [0, 0.5, 0], [0, 0, 0.125]])
    assert grid.measure().sum() == pytest.approx(1.0, rel=1e-12)
    found, cells = faces(grid.cells)
    assert set(cells) == {1, 2}
    outside = grid.points[found[cells == 1]]
    on_a_side = [
        (outside[:, :, axis] == side).all(axis=1)
        for axis, length in enumerate((1.0, 2.0, 0.5))
        for side in (0.0, length)
    ]
    assert [side.sum() for side in on_a_side] == 6 * [2 * 16]
    assert np.any(on_a_side, axis=0).all()


@pytest.mark.parametrize("tetrahedra", [5, 6])
def test_a_box_of_one_cell_has_its_edges(tetrahedra):
    grid = mesh.box((2, 2, 2), (1.0, 1.0, 1.0), tetrahedra)
    assert len(grid.edges) == 12 + 6 + (tetrahedra == 6)


@pytest.mark.parametrize(
    "grid",
    [
        mesh.rectangle((4, 3), (1.0, 1.0)),
        mesh.box((3, 4, 2), (1.0, 1.0, 1.0), 5),
        mesh.box((3, 4, 2), (1.0, 1.0, 1.0), 6),
    ],
)
def test_every_edge_of_the_cells_occurs_once_in_order(grid):
    pairs = {tuple(sorted(pair)) for cell in grid.cells.tolist() for pair in combinations(cell, 2)}
    assert sorted(pairs) == [tuple(edge) for edge in grid.edges.tolist()]


def test_grids_and_reordered_cells_have_positive_orientation():
    for grid in (
        mesh.rectangle((4, 3), (1.0, 1.0)),
        mesh.box((3, 3, 3), (1.0, 1.0, 1.0)),
        mesh.from_cells(SQUARE, TRIANGLES[:, ::-1]),
        mesh.from_cells(CORNER, [[0, 2, 1, 3]]),
    ):
        sides = grid.points[grid.cells[:, 1:]] - grid.points[grid.cells[:, :1]]
        assert (np.linalg.det(sides) > 0).all()


def test_mass_is_shared_equally_by_the_nodes_of_a_cell():
    square = mesh.from_cells(SQUARE, TRIANGLES)
    np.testing.assert_allclose(square.lumped_mass(3.0), [1, 2, 2, 1], rtol=1e-15)
    np.testing.assert_allclose(square.lumped_mass(np.array([3.0, 6.0])), [1, 3, 3, 2], rtol=1e-15)
    assert mesh.from_cells(CORNER, [[0, 1, 2, 3]]).lumped_mass(24.0) == pytest.approx(np.ones(4), rel=1e-15)


def test_parts_are_found():
    apart = mesh.from_cells(np.concatenate([SQUARE, SQUARE + 5]), np.concatenate([TRIANGLES, TRIANGLES + 4]))
    number, part = apart.components()
    assert number == 2 and np.array_equal(part, [0, 0, 0, 0, 1, 1, 1, 1])
    assert mesh.rectangle((3, 3), (1.0, 1.0)).components()[0] == 1


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: mesh.rectangle((5,), (1.0, 1.0)), "nodes must be 2 whole numbers of at least 2, not [5]"),
        (lambda: mesh.rectangle((5, 1), (1.0, 1.0)), "nodes must be 2 whole numbers of at least 2, not [5, 1]"),
        (lambda: mesh.rectangle((5, 2.0), (1, 1)), "nodes must be 2 whole numbers of at least 2, not [5, 2.0]"),
        (lambda: mesh.box((5, 2), (1.0, 1.0, 1.0)), "nodes must be 3 whole numbers of at least 2, not [5, 2]"),
        (lambda: mesh.rectangle((5, 2), (1.0,)), "size must be 2 finite numbers above 0, not [1.0]"),
        (lambda: mesh.rectangle((5, 2), (1.0, 0.0)), "size must be 2 finite numbers above 0, not [1.0, 0.0]"),
        (lambda: mesh.box((2, 2, 2), (1, -1, 1)), "size must be 3 finite numbers above 0, not [1, -1, 1]"),
        (lambda: mesh.box((2, 2, 2), (1, np.inf, 1)), "size must be 3 finite numbers above 0, not [1, inf, 1]"),
        (lambda: mesh.box((2, 2, 2), (1, 1, 1), 7), "tetrahedra must be 5 or 6, not 7"),
        (lambda: mesh.from_cells(SQUARE, [[0, 1, 4]]), "cells must be made of the points 0 to 3, not 4"),
        (lambda: mesh.from_cells(SQUARE, [[0, 1, -1]]), "cells must be made of the points 0 to 3, not -1"),
        (lambda: mesh.from_cells(SQUARE, np.empty((0, 3))), "cells must not be empty"),
        (
            lambda: mesh.from_cells(SQUARE, [[0, 1, 2], [1, 3, 2], [2, 0, 1]]),
            "cells must all differ, but cells 0 and 2 have the same nodes: remove one",
        ),
        (
            lambda: mesh.from_cells(SQUARE, [[0, 1, 2], [1, 3, 3]]),
            "cells must all have an area, unlike cell 1 (points [1, 3, 3])",
        ),
        (
            lambda: mesh.from_cells([[0, 0], [0.1, 0.1], [0.3, 0.3]], [[0, 1, 2]]),
            "cells must all have an area, unlike cell 0 (points [0, 1, 2])",
        ),
        (
            lambda: mesh.from_cells(np.column_stack([SQUARE, np.zeros(4)]), [[0, 1, 2, 3]]),
            "cells must all have a volume, unlike cell 0 (points [0, 1, 2, 3])",
        ),
        (
            lambda: mesh.from_cells([*SQUARE, [3, 3]], [[0, 1, 2], [1, 3, 2], [1, 4, 2]]),
            "cells must meet two at an edge, but 3 have the points [1, 2]: remove those that overlap",
        ),
        (
            lambda: mesh.from_cells([*CORNER, [1, 1, 1], [0, 0, -1]], [[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 2, 5]]),
            "cells must meet two at a face, but 3 have the points [0, 1, 2]: remove those that overlap",
        ),
        (
            lambda: mesh.from_cells(SQUARE, [[0, 1, 2]]),
            "points must all belong to a cell, but point 3 does not: remove it (1 of 4 are isolated)",
        ),
        (
            lambda: mesh.from_cells(SQUARE[[0, 1, 2, 1, 3, 2]], [[0, 1, 2], [3, 4, 5]]),
            "points must all differ, but 1 and 3 are at the same place: "
            "merge them (an edge of zero length has no direction)",
        ),
        (
            lambda: mesh.from_cells(
                np.float32(SQUARE[[0, 1, 2, 1, 3, 2]] / 3) + np.eye(6, 2, -4) * 1e-7, [[0, 1, 2], [3, 4, 5]]
            ),  # a seam that another program has rounded
            "points must all differ, but 1 and 3 are at the same place: "
            "merge them (an edge of zero length has no direction)",
        ),
        (lambda: mesh.from_cells(SQUARE * np.nan, TRIANGLES), "points must be finite coordinates in 2 or 3 dimensions"),
        (lambda: mesh.from_cells(SQUARE[:, :1], TRIANGLES), "points must be finite coordinates in 2 or 3 dimensions"),
        (
            lambda: mesh.Mesh(SQUARE + np.inf, TRIANGLES, TRIANGLES[:, :2]),
            "points must be finite coordinates in 2 or 3 dimensions",
        ),
        (
            lambda: mesh.Mesh(SQUARE[:2], TRIANGLES[:0], np.array([[1, 0]])),
            "edges must be pairs i < j in ascending order, each given once",
        ),
        (
            lambda: mesh.Mesh(SQUARE[:2], TRIANGLES[:0], np.array([[0, 1], [0, 1]])),
            "edges must be pairs i < j in ascending order, each given once",
        ),
        (
            lambda: mesh.Mesh(SQUARE[:2], TRIANGLES[:0], np.array([[0, 2]])),
            "edges must be made of the points 0 to 1, not 2",
        ),
    ],
)
def test_invalid_meshes_are_refused(build, message):
    with pytest.raises(InputError) as error:
        build()
    assert str(error.value) == message
