"""sim.report.page: figures as text."""

import pytest

from sim.report.page import brief, least, percent, si, slug


@pytest.mark.parametrize(
    "value, text",
    [
        (True, "yes"),
        (False, "no"),
        (None, "–"),
        (0.0, "0"),
        (3.21e-6, "3.2e-6"),
        (0.25, "0.25"),
        (12.345, "12.3"),
        (7, "7"),
        (1234567, "1\u202f234\u202f567"),
    ],
)
def test_a_figure_is_written_briefly(value, text):
    assert brief(value) == text


@pytest.mark.parametrize(
    "value, unit, text",
    [
        (0.01234, "N", "12.3 mN"),
        (-2e-7, "m", "−200 nm"),
        (1.0, "J", "1 J"),
        (0.0, "J", "0 J"),
        (0.75, "", "0.75"),
        (0.99996, "N", "1000 mN"),
        (54321.0, "N", "54300 N"),
    ],
)
def test_a_quantity_gets_a_prefix_to_its_unit(value, unit, text):
    assert si(value, unit) == text


def test_the_least_headroom_is_that_of_what_depends_on_the_scene():
    ranges = [
        {"unit": "", "headroom_bits": 0.0},
        {"unit": "N", "headroom_bits": 2.0},
        {"unit": "m", "headroom_bits": 1.5},
        {"unit": "m/s", "headroom_bits": None},
    ]
    assert least(ranges) == {"unit": "m", "headroom_bits": 1.5}


@pytest.mark.parametrize("part, text", [(0.5041, "50.4 %"), (-1e-9, "0.0 %"), (1.0, "100.0 %")])
def test_a_part_is_written_in_per_cent(part, text):
    assert percent(part) == text


@pytest.mark.parametrize("name, text", [("plastic-3d", "plastic-3d"), ("Wet clay / 2", "wet-clay-2"), ("//", "scene")])
def test_a_name_becomes_part_of_an_address(name, text):
    assert slug(name) == text
