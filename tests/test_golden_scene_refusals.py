"""golden.scene.load: every mistake in one line, with the path of the key, before anything runs."""

import numpy as np
import pytest
from scene_text import BOTTOM, GEL, MESH, SCENE, TOP, TWO, changed, written

from golden.scene import load as scenes
from golden.scene.load import load
from golden.support.errors import InputError


def refusal(path):
    """What `load` says about a file, without the file's name that it begins with."""
    with pytest.raises(InputError) as caught:
        load(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ") and "\n" not in message
    return message.removeprefix(f"{path}: ")


PRESETS = "viscoelastic, plastic, rheological, rheological-force, plastic-force"
REFUSED = [
    # keys and types
    (
        "dt = 1e-4\n",
        "dtt = 1e-4\n",
        "dtt must not be there: the keys known here are "
        "dt, mesh, materials, mass, phases, name, description, gravity, frames",
    ),
    ("dt = 1e-4\n", "", "dt must be given"),
    (MESH, "", "mesh must be given"),
    ("mass = { total = 2.0 }", "", "mass must be given"),
    ("dt = 1e-4", 'dt = "fast"', "dt must be a number, not 'fast'"),
    ("dt = 1e-4", "dt = true", "dt must be a number, not true"),
    ("dt = 1e-4", "dt = 2026-11-22", "dt must be a number, not 2026-11-22"),
    ("dt = 1e-4", "dt = nan", "dt must be a finite number, not nan"),
    ("dt = 1e-4", "dt = inf", "dt must be a finite number, not inf"),
    ("dt = 1e-4", "dt = 0", "dt must be a number above 0, not 0"),
    ("dt = 1e-4", "dt = -1e-4", "dt must be a number above 0, not -0.0001"),
    ('name = "block"', "name = 3", "name must be text, not 3"),
    ("gravity = [0, -9.81]", "gravity = -9.81", "gravity must be a list, not -9.81"),
    ("gravity = [0, -9.81]", 'gravity = [0, "g"]', "gravity[1] must be a number, not 'g'"),
    ("gravity = [0, -9.81]", "gravity = [0, -inf]", "gravity[1] must be a finite number, not -inf"),
    ("gravity = [0, -9.81]", "gravity = [0, 0, -9.81]", "gravity must have 2 components, as the mesh does, not 3"),
    # mesh
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
    # mass
    ("total = 2.0", "", "mass must have one of density and total, not neither"),
    ("total = 2.0", "total = 2.0, density = 1.0", "mass must have one of density and total, not both"),
    ("total = 2.0", "total = -2.0", "mass.total must be a number above 0, not -2.0"),
    ("total = 2.0", "density = 0", "mass.density must be a number above 0, not 0"),
    ("total = 2.0", "total = 2.0, unit = 'g'", "mass.unit must not be there: the keys known here are density, total"),
    # materials
    (GEL, "[materials]\n", "materials must hold at least one material, not none"),
    (GEL, "[materials]\ngel = 3\n", "materials.gel must be a table, not 3"),
    ('preset = "viscoelastic"\n', "", f"materials.gel.preset must be given: one of {PRESETS}"),
    ('"viscoelastic"', '"elastic"', f"materials.gel.preset must be one of {PRESETS}, not 'elastic'"),
    ('"viscoelastic"', "[]", f"materials.gel.preset must be one of {PRESETS}, not a list"),
    ("c1 = 1.0", "c2 = 1.0", "materials.gel.c2 must not be there: the keys known here are preset, region, k, c1"),
    ("k = 100.0\n", "", "materials.gel.k must be given"),
    ("k = 100.0", "k = -1.0", "materials.gel.k must be a finite number above 0, not -1.0"),
    ("k = 100.0", "k = '1'", "materials.gel.k must be a finite number above 0, not '1'"),
    ("k = 100.0", "k = inf", "materials.gel.k must be a finite number, not inf"),
    (
        '"viscoelastic"',
        '"rheological"\nc2 = 5.0\na_min = 0.7\na_max = 0.6',
        "materials.gel.a_min must be at most a_max = 0.6, not 0.7",
    ),
    (
        '"viscoelastic"',
        '"rheological"\nc2 = 5.0\na_min = 0.6',
        "materials.gel.a0 must lie between a_min = 0.6 and a_max = 1.0, not 0.5",
    ),
    (GEL, TWO.replace("f2 = 0.2", "f2 = 0.1"), "materials.clay.f2 must be above f1 = 0.1, not 0.1"),
    (GEL, TWO.replace("c_max = 100.0", "c_max = 0.5"), "materials.clay.c_min must be at most c_max = 0.5, not 1.0"),
    (
        GEL,
        TWO.replace("region = { box = { min = [0, 0], max = [0.1, 0.1] } }", "").replace(
            "region = { box = { min = [0.1, 0], max = [0.2, 0.1] } }", ""
        ),
        "materials.clay.region must be given, as materials.gel already has what the others leave",
    ),
    (
        GEL,
        TWO.replace("region = { box = { min = [0, 0], max = [0.1, 0.1] } }", "").replace("[0.1, 0]", "[0, 0]"),
        "materials.gel must have an element, but the others leave none",
    ),
    (
        GEL,
        TWO.replace("min = [0.1, 0]", "min = [0, 0]"),
        "materials.clay.region must not overlap materials.gel.region: both hold "
        "element 0 around [0.0666667, 0.0166667] and 3 more",
    ),
    (
        GEL,
        TWO.replace("min = [0.1, 0]", "min = [0.15, 0]"),
        "materials must cover every element, but none holds element 2 around [0.133333, 0.0166667] and 1 more",
    ),
    (
        GEL,
        TWO.replace("min = [0.1, 0]", "min = [0.19, 0]"),
        "materials.clay.region must hold at least one element, not none: "
        "the object reaches from [0.0, 0.0] to [0.2, 0.1]",
    ),
    (
        GEL,
        TWO.replace("box = { min = [0.1, 0], max = [0.2, 0.1] }", "nodes = [0, 1]"),
        "materials.clay.region must hold at least one element, not none: "
        "the object reaches from [0.0, 0.0] to [0.2, 0.1]",
    ),
    (
        GEL,
        TWO.replace("box = { min = [0.1, 0], max = [0.2, 0.1] }", "box = { min = [0.1, 0] }"),
        "materials.clay.region.box.max must be given",
    ),
    # phases
    (SCENE[SCENE.index("[[phases]]") :], "", "phases must be given"),
    (SCENE, "phases = []\n" + SCENE[: SCENE.index("[[phases]]")], "phases must hold at least one phase, not none"),
    ("duration = 0.01\n", "", "phases[0].duration must be given"),
    ("duration = 0.01\n", "duration = 0\n", "phases[0].duration must be a number above 0, not 0"),
    ("duration = 0.005", "duration = 4e-5", "phases[1].duration must be at least one step of dt = 0.0001, not 4e-05"),
    (
        "fixed = [",
        "fixd = [",
        "phases[0].fixd must not be there: the keys known here are duration, name, fixed, driven, loads, materials",
    ),
    (f"fixed = [{BOTTOM}]", "fixed = { nodes = [1] }", "phases[0].fixed must be a list, not a table"),
    (BOTTOM, "{ }", "phases[0].fixed[0] must have one of box, plane, ball, nodes, not none"),
    (
        BOTTOM,
        BOTTOM[:-1] + ", nodes = [1] }",
        "phases[0].fixed[0] must have one of box, plane, ball, nodes, not plane and nodes",
    ),
    (
        BOTTOM,
        "{ sphere = 1 }",
        "phases[0].fixed[0].sphere must not be there: the keys known here are box, plane, ball, nodes",
    ),
    (BOTTOM, "{ plane = { axis = 'y' } }", "phases[0].fixed[0].plane.at must be given"),
    (BOTTOM, "{ plane = 'y' }", "phases[0].fixed[0].plane must be a table, not 'y'"),
    (BOTTOM, "{ plane = { axis = 'z', at = 0 } }", "phases[0].fixed[0].plane.axis must be one of x, y, not 'z'"),
    (BOTTOM, "{ plane = { axis = 'xy', at = 0 } }", "phases[0].fixed[0].plane.axis must be one of x, y, not 'xy'"),
    (
        BOTTOM,
        "{ plane = { axis = 'y', at = 0, tolerance = -1 } }",
        "phases[0].fixed[0].plane.tolerance must be a number of at least 0, not -1.0",
    ),
    (
        BOTTOM,
        "{ plane = { axis = 'y', at = 0, thick = 1 } }",
        "phases[0].fixed[0].plane.thick must not be there: the keys known here are axis, at, tolerance",
    ),
    (
        BOTTOM,
        "{ plane = { axis = 'y', at = 0.02 } }",
        "phases[0].fixed[0] must hold at least one node, not none: the object reaches from [0.0, 0.0] to [0.2, 0.1]",
    ),
    (
        BOTTOM,
        "{ ball = { center = [0, 0], radius = 0 } }",
        "phases[0].fixed[0].ball.radius must be a number above 0, not 0.0",
    ),
    (
        BOTTOM,
        "{ ball = { center = [0, 0, 0], radius = 1 } }",
        "phases[0].fixed[0].ball.center must have 2 components, as the mesh does, not 3",
    ),
    (
        BOTTOM,
        "{ nodes = [] }",
        "phases[0].fixed[0] must hold at least one node, not none: the object reaches from [0.0, 0.0] to [0.2, 0.1]",
    ),
    (BOTTOM, "{ nodes = [0, 9] }", "phases[0].fixed[0].nodes[1] must be a node from 0 to 8, not 9"),
    (BOTTOM, "{ nodes = [-1] }", "phases[0].fixed[0].nodes[0] must be a node from 0 to 8, not -1"),
    (BOTTOM, "{ nodes = [0.5] }", "phases[0].fixed[0].nodes[0] must be a whole number, not 0.5"),
    (
        BOTTOM,
        "{ box = { min = [0], max = [1, 0] } }",
        "phases[0].fixed[0].box.min must have 2 components, as the mesh does, not 1",
    ),
    (
        BOTTOM,
        "{ box = { min = [0, 0], max = [0, 0, 0] } }",
        "phases[0].fixed[0].box.max must have 2 components, as the mesh does, not 3",
    ),
    (
        BOTTOM,
        "{ box = { min = [0, 0.1], max = [1, 0] } }",
        "phases[0].fixed[0].box.max must be at least [0.0, 0.1] everywhere, not [1.0, 0.0]",
    ),
    (", velocity = [0, -0.5]", "", "phases[0].driven[0].velocity must be given"),
    (
        "velocity = [0, -0.5]",
        "velocity = [0, -0.5, 0]",
        "phases[0].driven[0].velocity must have 2 components, as the mesh does, not 3",
    ),
    (TOP, "{ nodes = [8, 2], velocity = [0, 0] }", "phases[0].driven[0] must not hold node 2, which is fixed"),
    (TOP, f"{TOP}, {TOP}", "phases[0].driven[1] must not hold node 6, which is driven a second time"),
    ("force = [1, 0]", "force = 1", "phases[0].loads[0].force must be a list, not 1"),
    ("force = [1, 0]", "force = [1, 0, 0]", "phases[0].loads[0].force must have 2 components, as the mesh does, not 3"),
    # frames
    ("every = 30", "", "frames must have one of every and count, not neither"),
    ("every = 30", "every = 30, count = 3", "frames must have one of every and count, not both"),
    ("every = 30", "every = 0", "frames.every must be a whole number of at least 1, not 0"),
    ("every = 30", "count = 2.5", "frames.count must be a whole number, not 2.5"),
]


@pytest.mark.parametrize("old, new, message", REFUSED)
def test_refusals(tmp_path, old, new, message):
    assert refusal(written(tmp_path, changed(SCENE, old, new))) == message


def test_dt_above_the_stability_bound(tmp_path):
    stiff = changed(SCENE, "k = 100.0", "k = 1e8")
    message = refusal(written(tmp_path, stiff))
    assert message.startswith("dt must be at most ") and "not 0.0001" in message and "'gel'" in message
    allowed = message.split()[5]
    assert load(written(tmp_path, changed(stiff, "dt = 1e-4", f"dt = {allowed}"))).dt == float(allowed)


def part(folder, points, cells):
    """A scene with a mesh file of its own beside it."""
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
def test_meshes_that_make_no_object(tmp_path, points, cells, message):
    text = changed(SCENE, MESH, part(tmp_path, points, cells))
    assert refusal(written(tmp_path, text)) == message


def test_missing_mesh_file(tmp_path):
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
def test_parts_that_nothing_holds(tmp_path, fixed, message):
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


@pytest.mark.parametrize(
    "content, message",
    [
        (None, "the scene must be a readable file: No such file or directory"),
        (b"dt = 1e-4\nmesh == 3\n", "the scene must be a TOML file: Invalid value (at line 2, column 7)"),
        (b"dt = 1\ndt = 2\n", "the scene must be a TOML file: Cannot overwrite a value (at line 2, column 7)"),
        (
            b"\xff",
            "the scene must be a TOML file: 'utf-8' codec can't decode byte 0xff in position 0: invalid start byte",
        ),
    ],
)
def test_files_that_are_no_scene(tmp_path, content, message):
    path = tmp_path / "scene.toml"
    if content is not None:
        path.write_bytes(content)
    assert refusal(path) == message


def test_folder(tmp_path):
    assert refusal(tmp_path) == "the scene must be a readable file: Is a directory"


def test_nothing_runs_before_the_checks(tmp_path, monkeypatch):
    """The bound on dt is the last and dearest check: a mistake anywhere else is found before."""
    monkeypatch.setattr(scenes.stability, "check", lambda scene: pytest.fail("too early"))
    assert refusal(written(tmp_path, changed(SCENE, "every = 30", "every = 0")))
