"""Text of a small scene, for tests that change a line of it."""

import pytest

from golden.scene.load import load
from golden.support.errors import InputError

SCENE = """\
name = "block"
dt = 1e-4
gravity = [0, -9.81]
mesh = { kind = "rectangle", nodes = [3, 3], size = [0.2, 0.1] }
mass = { total = 2.0 }
frames = { every = 30 }

[materials.gel]
preset = "viscoelastic"
k = 100.0
c1 = 1.0

[[phases]]
name = "press"
duration = 0.01
fixed = [{ plane = { axis = "y", at = 0.0 } }]
driven = [{ box = { min = [0, 0.1], max = [0.2, 0.1] }, velocity = [0, -0.5] }]
loads = [{ nodes = [4], force = [1, 0] }, { plane = { axis = "y", at = 0.05 }, force = [0, 2] }]

[[phases]]
duration = 0.005
"""
TWO = """\
[materials.gel]
preset = "viscoelastic"
k = 100.0
c1 = 1.0
region = { box = { min = [0, 0], max = [0.1, 0.1] } }

[materials.clay]
preset = "rheological-force"
k = 100.0
c1 = 1.0
f1 = 0.1
f2 = 0.2
c_max = 100.0
c_min = 1.0
region = { box = { min = [0.1, 0], max = [0.2, 0.1] } }
"""
GEL = SCENE[SCENE.index("[materials.gel]") : SCENE.index("[[phases]]")]
MESH = 'mesh = { kind = "rectangle", nodes = [3, 3], size = [0.2, 0.1] }'
BOTTOM = '{ plane = { axis = "y", at = 0.0 } }'
TOP = "{ box = { min = [0, 0.1], max = [0.2, 0.1] }, velocity = [0, -0.5] }"


def written(folder, text=SCENE):
    path = folder / "scene.toml"
    path.write_text(text)
    return path


def changed(text, old, new):
    assert text.count(old) >= 1, old
    return text.replace(old, new, 1)


def refusal(path):
    """Return the message with which `golden.scene.load.load` refuses a file, without the file's name."""
    with pytest.raises(InputError) as caught:
        load(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ") and "\n" not in message
    return message.removeprefix(f"{path}: ")
