"""`golden.scene.load`: every mistake in one line, with the path of the key, before anything runs.

Mistakes in meshes, materials and phases have files of their own.
"""

import pytest
from scene_text import MESH, SCENE, changed, refusal, written

from golden.scene import load as scenes
from golden.scene.load import load

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
    # mass
    ("total = 2.0", "", "mass must have one of density and total, not neither"),
    ("total = 2.0", "total = 2.0, density = 1.0", "mass must have one of density and total, not both"),
    ("total = 2.0", "total = -2.0", "mass.total must be a number above 0, not -2.0"),
    ("total = 2.0", "density = 0", "mass.density must be a number above 0, not 0"),
    ("total = 2.0", "total = 2.0, unit = 'g'", "mass.unit must not be there: the keys known here are density, total"),
    # frames
    ("every = 30", "", "frames must have one of every and count, not neither"),
    ("every = 30", "every = 30, count = 3", "frames must have one of every and count, not both"),
    ("every = 30", "every = 0", "frames.every must be a whole number of at least 1, not 0"),
    ("every = 30", "count = 2.5", "frames.count must be a whole number, not 2.5"),
]


@pytest.mark.parametrize("old, new, message", REFUSED)
def test_what_a_scene_must_not_say_is_refused(tmp_path, old, new, message):
    assert refusal(written(tmp_path, changed(SCENE, old, new))) == message


def test_a_dt_above_the_stability_bound_is_refused(tmp_path):
    stiff = changed(SCENE, "k = 100.0", "k = 1e8")
    message = refusal(written(tmp_path, stiff))
    assert message.startswith("dt must be at most ") and "not 0.0001" in message and "'gel'" in message
    allowed = message.split()[5]
    assert load(written(tmp_path, changed(stiff, "dt = 1e-4", f"dt = {allowed}"))).dt == float(allowed)


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
def test_files_that_are_not_scenes_are_refused(tmp_path, content, message):
    path = tmp_path / "scene.toml"
    if content is not None:
        path.write_bytes(content)
    assert refusal(path) == message


def test_a_folder_is_refused(tmp_path):
    assert refusal(tmp_path) == "the scene must be a readable file: Is a directory"


def test_the_bound_on_dt_is_checked_last(tmp_path, monkeypatch):
    """The bound on dt takes longest and is checked last: any other mistake is found first."""
    monkeypatch.setattr(scenes.stability, "check", lambda scene: pytest.fail("too early"))
    assert refusal(written(tmp_path, changed(SCENE, "every = 30", "every = 0")))
