"""Mesh files: formats, order of points and cells, refusals."""

import meshio
import numpy as np
import pytest

from golden.mesh import mesh
from golden.support.errors import InputError

TRIANGLES = np.array([[0, 1, 2], [1, 3, 2]])
SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [2.0, 1.0]])
CORNER = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
FLAT = np.column_stack([SQUARE, np.full(4, 7.0)])
BOUNDARY = [("vertex", [[0]]), ("line", [[0, 1], [1, 3]])]


@pytest.mark.parametrize("kind", ["vtk", "vtu", "mesh", "msh", "obj", "ply"])
def test_triangles_from_a_file(tmp_path, kind):
    path = tmp_path / f"plate.{kind}"
    boundary = BOUNDARY if kind in ("vtk", "vtu", "mesh") else []
    meshio.write_points_cells(path, FLAT, [*boundary, ("triangle", TRIANGLES)])
    read = mesh.read(path, scale=0.5)
    assert read.dim == 2 and len(read.edges) == 5
    assert read.measure() == pytest.approx([0.25, 0.25], rel=1e-12)


def test_triangles_in_two_blocks_keep_the_order_of_the_file(tmp_path):
    blocks = [("triangle", TRIANGLES[1:]), ("triangle", TRIANGLES[:1])]
    meshio.write_points_cells(tmp_path / "p.vtk", FLAT, blocks)
    read = mesh.read(tmp_path / "p.vtk")
    assert np.array_equal(read.cells, TRIANGLES[::-1]) and np.array_equal(read.points, SQUARE)


GMSH_41 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
4 4 1 4
0 1 0 1
1
0 0 0
1 1 0 1
2
1 0 0
2 1 0 1
3
0 1 0
3 1 0 1
4
0 0 1
$EndNodes
$Elements
4 4 1 4
0 1 15 1
1 1
1 1 1 1
2 1 2
2 1 2 1
3 1 2 3
3 1 4 1
4 1 2 3 4
$EndElements
"""
GMSH_22 = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$EndNodes
$Elements
4
1 15 2 0 1 1
2 1 2 0 1 1 2
3 2 2 0 1 1 2 3
4 4 2 0 1 1 2 3 4
$EndElements
"""


@pytest.mark.parametrize("text", [GMSH_22, GMSH_41])
def test_tetrahedra_with_their_boundary_from_gmsh(tmp_path, text):
    (tmp_path / "corner.msh").write_text(text)
    read = mesh.read(tmp_path / "corner.msh")
    assert np.array_equal(read.points, CORNER) and np.array_equal(read.cells, [[0, 1, 2, 3]])


HINT = "mesh the whole object with first-order triangles or with first-order tetrahedra"
QUAD = ("quad", np.array([[0, 1, 3, 2]]))
PYRAMID = ("pyramid", np.array([[0, 1, 3, 2, 4]]))
PEAK = np.concatenate([FLAT, [[1.0, 0.5, 9.0]]])


@pytest.mark.parametrize(
    ("points", "cells", "message"),
    [
        (FLAT, [QUAD], f"file must hold triangles or tetrahedra, not quad (in {{path}}): {HINT}"),
        (FLAT, BOUNDARY, f"file must hold triangles or tetrahedra, not line, vertex (in {{path}}): {HINT}"),
        (
            np.concatenate([FLAT[:3], FLAT[:3] + [0.1, 0.1, 0]]),
            [("triangle6", np.arange(6)[None])],
            f"file must hold triangles or tetrahedra, not triangle6 (in {{path}}): {HINT}",
        ),
        (
            FLAT,
            [("triangle", TRIANGLES), QUAD],
            f"file must hold triangle cells alone, not quad beside them (in {{path}}): {HINT}",
        ),
        (
            PEAK,
            [("tetra", np.array([[0, 1, 2, 4]])), PYRAMID],
            f"file must hold tetra cells alone, not pyramid beside them (in {{path}}): {HINT}",
        ),
        (
            PEAK,
            [("triangle", np.array([[0, 1, 4], [0, 4, 2], [1, 3, 4]]))],
            "file must hold triangles in one plane of constant z, not a surface in space (in {path}): "
            "make the mesh flat, or fill the surface with tetrahedra",
        ),
        (
            PEAK,
            [("triangle", TRIANGLES)],
            "file must hold triangles in one plane of constant z, not a surface in space (in {path}): "
            "make the mesh flat, or fill the surface with tetrahedra",
        ),
        (
            np.concatenate([FLAT, FLAT[:1] - 1])[:, :2],
            [("triangle", TRIANGLES)],
            "points must all belong to a cell, but point 4 does not: remove it (1 of 5 are isolated)",
        ),
    ],
)
def test_files_of_anything_else_are_refused(tmp_path, points, cells, message):
    path = tmp_path / "object.vtk"
    meshio.write_points_cells(path, points, [(kind, np.asarray(block)) for kind, block in cells])
    with pytest.raises(InputError) as error:
        mesh.read(path)
    assert str(error.value) == message.format(path=path)


def test_a_file_without_cells_is_refused(tmp_path):
    path = tmp_path / "object.mesh"
    path.write_text("MeshVersionFormatted 1\nDimension 3\nVertices\n1\n0 0 0 0\nEnd\n")
    with pytest.raises(InputError) as error:
        mesh.read(path)
    assert str(error.value) == f"file must hold triangles or tetrahedra, not nothing (in {path}): {HINT}"


@pytest.mark.parametrize("content", [b"", b"not a mesh", b"$MeshFormat\n4.1 0 8\n"])
@pytest.mark.parametrize("name", ["object.msh", "object.vtk", "object.unknown", "object"])
def test_files_that_cannot_be_read_are_refused(tmp_path, capfd, name, content):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError) as error:
        mesh.read(path)
    assert str(error.value) == f"file must be a mesh that meshio can read, not {path}"
    assert capfd.readouterr() == ("", "")


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(InputError) as error:
        mesh.read(tmp_path / "none.msh")
    assert str(error.value) == f"file must be an existing mesh file, not {tmp_path / 'none.msh'}"


@pytest.mark.parametrize("scale", [0, -1.0, np.nan, np.inf, "1", True])
def test_scale_must_be_a_positive_number(tmp_path, scale):
    with pytest.raises(InputError) as error:
        mesh.read(tmp_path / "none.msh", scale)
    assert str(error.value) == f"scale must be a finite number above 0, not {scale!r}"
