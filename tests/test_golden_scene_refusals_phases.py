"""Mistakes in a scene's phases, each in one line with the path of the key."""

import pytest
from scene_text import BOTTOM, SCENE, TOP, changed, refusal, written

REFUSED = [
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
]


@pytest.mark.parametrize("old, new, message", REFUSED)
def test_wrong_phases_are_refused(tmp_path, old, new, message):
    assert refusal(written(tmp_path, changed(SCENE, old, new))) == message
