"""Materials that a phase brings: float64, integer model and circuit go on with them, without a jump in force."""

import dataclasses

import numpy as np
import pytest
import scene_text
from sim_objects import MATERIALS, block

from golden.physics.model import Model
from golden.scene import archive
from golden.scene import load as scenes
from golden.support.errors import InputError
from sim.compare import compare
from sim.results import energy, ranges
from sim.results.comparison import BOUND
from sim.run import run

PHASE = "duration = 0.005\n"
BROUGHT = """\
duration = 0.005

[phases.materials.gel]
preset = "rheological"
k = 80.0
c1 = 2.0
c2 = 40.0
"""


def switching(name="viscoelastic", other="rheological", **kwargs):
    """Return a block that becomes another material when it is held."""
    scene = block(name, steps=(60, 60, 120), every=1, **kwargs)
    phases = list(scene.phases)
    other = dataclasses.replace(MATERIALS[other], name=scene.materials[0].name)
    phases[1] = dataclasses.replace(phases[1], materials=(other,))
    return dataclasses.replace(scene, phases=tuple(phases))


def loaded(tmp_path, text):
    return scenes.load(scene_text.written(tmp_path, text))


def test_a_phase_of_a_scene_file_brings_materials(tmp_path):
    scene = loaded(tmp_path, scene_text.changed(scene_text.SCENE, PHASE, BROUGHT))
    press, release = scene.phases
    assert press.materials is None and [m.c1 for m in release.materials] == [2.0] and scene.materials[0].c1 == 1.0


def test_other_materials_stay(tmp_path):
    text = scene_text.changed(scene_text.SCENE, scene_text.GEL, scene_text.TWO)
    scene = loaded(tmp_path, scene_text.changed(text, PHASE, BROUGHT))
    gel, clay = scene.phases[1].materials
    assert (gel.c1, clay) == (2.0, scene.materials[1]) and scene.force_dependent


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'gel]\npreset = "rh',
            'dough]\npreset = "rh',
            "phases[1].materials.dough must not be there: the keys known here are gel",
        ),
        (
            "c2 = 40.0\n",
            "c2 = 40.0\nregion = { nodes = [1] }\n",
            "phases[1].materials.gel.region must not be there: a material is another one where it is",
        ),
        ("c2 = 40.0\n", "", "phases[1].materials.gel.c2 must be given"),
        ("c2 = 40.0\n", "c2 = -1\n", "phases[1].materials.gel.c2 must be a finite number above 0, not -1"),
        ("k = 80.0", "k = 8e9", "dt must be at most"),
        (
            "duration = 0.01\n",
            BROUGHT.replace("0.005", "0.01") + "[[phases]]\nduration = 1.0\n",
            "phases[0].materials must not be there: the object begins with those of materials",
        ),
    ],
)
def test_mistakes_in_a_phases_materials_are_named(tmp_path, old, new, message):
    text = scene_text.changed(scene_text.SCENE, PHASE, BROUGHT)
    with pytest.raises(InputError) as error:
        loaded(tmp_path, scene_text.changed(text, old, new))
    assert message in str(error.value)


def test_an_archive_keeps_a_phases_materials(tmp_path):
    scene = switching()
    archive.save(scene, tmp_path / "scene.npz")
    assert [p.materials for p in archive.load(tmp_path / "scene.npz").phases] == [p.materials for p in scene.phases]


@pytest.mark.parametrize("other", ["rheological", "rheological-force"])
def test_the_force_does_not_jump(other):
    """The force changes as little between two steps at the switch as before it."""
    scene = switching(other=other)
    model = Model(scene)
    for _ in range(scene.phases[0].steps):
        model.step()
    model.v[scene.phases[1].held] = 0
    before, _ = model.edges(model.x, model.v, model.a)
    model.change_materials(scene.phases[1].materials)
    after, _ = model.edges(model.x, model.v, model.a)
    assert np.abs(after - before).max() < 1e-9 * np.abs(before).max()


@pytest.mark.parametrize(
    "names",
    [
        ("viscoelastic", "rheological"),
        ("rheological", "viscoelastic"),
        ("rheological", "rheological-force"),
        ("plastic", "rheological"),
    ],
    ids="-".join,
)
def test_float_and_integers_become_the_same(names):
    scene = switching(*names)
    float64, fixed = run(scene, "float").trajectory, run(scene, "fixed").trajectory
    assert np.linalg.norm(fixed.x - float64.x, axis=2).max() / scene.size < BOUND[scene.force_dependent]
    unswitched = run(block(names[0], steps=(60, 60, 120), every=1), "float").trajectory
    assert np.abs(unswitched.x - float64.x).max() / scene.size > 1e-3  # there is something to see


def test_forces_and_ranges_are_those_of_the_materials_of_the_time():
    """At a held node in equilibrium with its device the forces of the edges are the reaction."""
    scene = switching("rheological", "viscoelastic")
    result = run(scene, "float")
    forces, (i, j) = energy.edge_forces(scene, result.trajectory), scene.mesh.edges.T
    for frame, (x, reaction) in enumerate(zip(result.trajectory.x, result.trajectory.reaction, strict=True)):
        d = x[j] - x[i]
        push, total = forces[frame, :, None] * d / np.linalg.norm(d, axis=1)[:, None], np.zeros_like(x)
        np.subtract.at(total, i, push)
        np.add.at(total, j, push)
        held = reaction != 0
        assert np.allclose(total[held], -reaction[held], atol=1e-9 * np.abs(reaction).max()), frame
    seen = {entry["quantity"]: entry["largest"] for entry in ranges.measure(scene, run(scene, "fixed").raw)}
    assert seen["ratio_next"] == 1.0  # the viscoelastic ratio: the other one's stays below


def test_the_circuit_gives_the_bits_of_the_integer_model():
    entry = compare(switching(), lanes=2).entry()
    assert entry["rtl_equals_fixed"] and not entry["saturations"]
