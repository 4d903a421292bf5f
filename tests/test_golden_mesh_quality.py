"""The radius ratio of triangles and tetrahedra whose circles and spheres are known."""

from math import sqrt

import numpy as np
import pytest

from golden.mesh.quality import radius_ratio, signed_measure

TRIANGLE = np.array([[[0, 0], [1, 0], [0.5, sqrt(3) / 2]]])
TETRAHEDRON = np.array([[[1, 1, 1], [-1, 1, -1], [1, -1, -1], [-1, -1, 1]]], dtype=float)
CORNER = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]], dtype=float)


@pytest.mark.parametrize("cell", [TRIANGLE, TETRAHEDRON])
def test_equal_sides_are_1(cell):
    assert radius_ratio(cell) == pytest.approx(1, rel=1e-12)
    assert radius_ratio(cell[:, [1, 0, *range(2, cell.shape[1])]]) == pytest.approx(-1, rel=1e-12)


def test_right_angles_have_their_known_ratios():
    """3-4-5: r = 1, R = 5/2; the corner of a cube: r = 1 / (3 + sqrt 3), R = sqrt(3) / 2."""
    assert radius_ratio(np.array([[[0, 0], [4, 0], [0, 3]]])) == pytest.approx(2 * 1 / 2.5, rel=1e-12)
    assert radius_ratio(CORNER) == pytest.approx(3 / (3 + sqrt(3)) / (sqrt(3) / 2), rel=1e-12)


@pytest.mark.parametrize("dim", [2, 3])
def test_size_place_and_turn_change_nothing(dim, rng):
    cells = rng.standard_normal((50, dim + 1, dim))
    turn, _ = np.linalg.qr(rng.standard_normal((dim, dim)))
    turn[0] *= np.sign(np.linalg.det(turn))
    moved = 1e-3 * cells @ turn.T + rng.standard_normal(dim)
    np.testing.assert_allclose(radius_ratio(moved), radius_ratio(cells), rtol=1e-6)
    np.testing.assert_array_equal(np.sign(radius_ratio(cells)), np.sign(signed_measure(cells)))
    assert np.abs(radius_ratio(cells)).max() <= 1


@pytest.mark.parametrize(
    "cell",
    [
        [[0, 0], [1, 0], [3, 0]],
        [[0, 0], [1, 0], [1, 0]],
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],  # a sliver: four corners of a square
        [[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 1]],
        [[0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]],
    ],
)
def test_flat_cells_are_0(cell):
    assert radius_ratio(np.array([cell], dtype=float)) == 0


def test_slivers_are_found_whose_sides_are_all_long():
    """A square with one corner lifted a little: no short edge, no small face, and yet nearly no volume."""
    lifted = np.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.01]]])
    assert 0 < abs(radius_ratio(lifted)[0]) < 0.02
