"""sim.report: the surface that a reader sees, and its colours."""

import numpy as np
import pytest
from sim_objects import MESHES

from golden.mesh import mesh
from sim.report import style, surface


def test_colours_run_from_dark_to_light_or_through_grey():
    for name, scale in style.scales().items():
        light = [np.dot(scale(n / 20)[:3], [0.2126, 0.7152, 0.0722]) for n in range(21)]
        assert (np.diff(light) > 0).all() if name != "force" else np.argmax(light) == 10


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


def test_outlines_have_the_length_of_the_border():
    m = MESHES[2]
    border = surface.outline(m)
    assert np.linalg.norm(border[:, 1] - border[:, 0], axis=1).sum() == pytest.approx(2 * (0.1 + 0.08))
    box = surface.outline(MESHES[3])
    assert len(box) == 9
    assert sorted(np.linalg.norm(box[:, 1] - box[:, 0], axis=1)) == pytest.approx([0.06] * 3 + [0.08] * 3 + [0.1] * 3)
