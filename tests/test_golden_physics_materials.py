"""Presets: the design's table, and the parameters that they refuse."""

import math

import pytest

from golden.physics.dampers import Exponential, Linear
from golden.physics.materials import PRESETS, Material
from golden.support.errors import InputError

FORCE = dict(f1=0.5, f2=2.0, c_max=100.0, c_min=1.0)
VALID = {
    "viscoelastic": dict(k=100.0, c1=1.0),
    "plastic": dict(c_damper=2.0),
    "rheological": dict(k=100.0, c1=1.0, c2=3.0),
    "rheological-force": dict(k=100.0, c1=1.0, **FORCE),
    "plastic-force": dict(c1=900.0, **FORCE),
}
inf = math.inf


@pytest.mark.parametrize(
    ("preset", "expected"),
    [
        ("viscoelastic", Material("m", 100.0, 1.0, Linear(inf), 1.0, 1.0, 1.0)),
        ("plastic", Material("m", 0.0, 4.0, Linear(4.0), 0.0, 1.0, 0.5)),
        ("rheological", Material("m", 100.0, 1.0, Linear(3.0), 0.0, 1.0, 0.5)),
        ("rheological-force", Material("m", 100.0, 1.0, Exponential(**FORCE), 0.0, 1.0, 0.5)),
        ("plastic-force", Material("m", 0.0, 900.0, Exponential(**FORCE), 0.0, 1.0, 0.1)),
    ],
)
def test_presets_give_the_table_of_the_design(preset, expected):
    material = PRESETS[preset]("m", **VALID[preset])
    assert material == expected
    assert material.damper.force_dependent == preset.endswith("force")


def test_a_damper_with_equal_coefficients_is_linear():
    assert PRESETS["plastic-force"]("m", c1=9.0, f1=0.0, f2=1.0, c_max=2.0, c_min=2.0).damper == Linear(2.0)


POSITIVE = "{} must be a finite number above 0, not {!r}"
NOT_NEGATIVE = "{} must be a finite number of at least 0, not {!r}"
ZERO_ALLOWED = {"c1", "f1", "a_min", "a_max", "a0"}


@pytest.mark.parametrize("preset", VALID)
@pytest.mark.parametrize("value", [-1.0, math.nan, inf, "3", True, None])
def test_each_parameter_must_be_a_finite_number(preset, value):
    parameters = dict(VALID[preset])
    if preset.startswith("rheological"):
        parameters |= dict(a_min=0.0, a_max=1.0, a0=0.5)
    for name in parameters:
        zero_allowed = name in ZERO_ALLOWED and (preset, name) != ("plastic-force", "c1")
        with pytest.raises(InputError) as error:
            PRESETS[preset]("m", **parameters | {name: value})
        assert str(error.value) == (NOT_NEGATIVE if zero_allowed else POSITIVE).format(name, value)


@pytest.mark.parametrize(
    ("preset", "name"),
    [
        ("viscoelastic", "k"),
        ("plastic", "c_damper"),
        ("rheological", "k"),
        ("rheological", "c2"),
        ("rheological-force", "f2"),
        ("rheological-force", "c_max"),
        ("rheological-force", "c_min"),
        ("plastic-force", "c1"),
    ],
)
def test_zero_where_it_has_no_meaning(preset, name):
    with pytest.raises(InputError) as error:
        PRESETS[preset]("m", **VALID[preset] | {name: 0.0})
    assert str(error.value) == POSITIVE.format(name, 0.0)


@pytest.mark.parametrize(
    ("preset", "change", "message"),
    [
        ("rheological", dict(a_max=1.5), "a_max must be at most 1, not 1.5"),
        ("rheological", dict(a0=1.1), "a0 must be at most 1, not 1.1"),
        ("rheological", dict(a_min=0.6, a_max=0.4), "a_min must be at most a_max = 0.4, not 0.6"),
        ("rheological", dict(a_min=0.6), "a0 must lie between a_min = 0.6 and a_max = 1.0, not 0.5"),
        ("rheological-force", dict(a_max=0.4), "a0 must lie between a_min = 0.0 and a_max = 0.4, not 0.5"),
        ("rheological-force", dict(f1=2.0), "f2 must be above f1 = 2.0, not 2.0"),
        ("plastic-force", dict(f1=3.0), "f2 must be above f1 = 3.0, not 2.0"),
        ("plastic-force", dict(c_min=200.0), "c_min must be at most c_max = 100.0, not 200.0"),
    ],
)
def test_parameters_must_fit_each_other(preset, change, message):
    with pytest.raises(InputError) as error:
        PRESETS[preset]("m", **VALID[preset] | change)
    assert str(error.value) == message


def test_an_error_can_be_put_under_a_path():
    assert str(InputError("k must be 1, not 2").under("materials.gel")) == "materials.gel.k must be 1, not 2"
