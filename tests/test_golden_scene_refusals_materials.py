"""Mistakes in a scene's materials and their regions, each in one line with the path of the key."""

import pytest
from scene_text import GEL, SCENE, TWO, changed, refusal, written

PRESETS = "viscoelastic, plastic, rheological, rheological-force, plastic-force"
REFUSED = [
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
]


@pytest.mark.parametrize("old, new, message", REFUSED)
def test_wrong_materials_are_refused(tmp_path, old, new, message):
    assert refusal(written(tmp_path, changed(SCENE, old, new))) == message
