"""The pictures with cycles: what they say is what the schedule and the latency table say."""

import re
from types import SimpleNamespace
from xml.etree import ElementTree

import pytest

from hw.docs.chart import rows_of
from hw.docs.core import core, loop
from hw.docs.lane import QUANTITIES, lane
from hw.emit.latencies import latencies
from hw.machine.core import datapaths
from hw.machine.issued import FETCHED
from hw.parameters import Parameters

STAGE = "stage", "issue of an edge to its issue in the next stage, at least"
SUMS = "edge", "issue to the sums that contain its force"
WRITTEN = "edge", "issue to its new ratio in the memory"
CIRCUITS = [Parameters(), Parameters(lanes=1), Parameters(lanes=1, axes=1), Parameters(updates=2)]
circuits = pytest.mark.parametrize("parameters", CIRCUITS, ids=["default", "one lane", "one axis", "two updates"])


def cycles(parameters):
    return {(part, path): number for part, path, number in latencies(parameters)}


def words(picture):
    """Return all texts of an SVG, which must be well-formed."""
    return [element.text for element in ElementTree.fromstring(picture).iter() if element.tag.endswith("}text")]


@circuits
def test_the_loop_has_the_cycles_of_a_stage(parameters):
    assert sum(loop(parameters).values()) == cycles(parameters)[STAGE]
    assert min(loop(parameters).values()) >= 1


@circuits
def test_the_core_shows_every_part_of_the_loop(parameters):
    said = words(core(parameters))
    shown = [int(number) for text in said for number in re.findall(r"^\d+(?= cycles,|$)", text)]
    assert sorted(shown) == sorted([*loop(parameters).values(), cycles(parameters)[WRITTEN]])
    assert f"{parameters.lanes} lane{'s' * (parameters.lanes > 1)}, each with" in said


def test_each_quantity_is_done_when_its_last_operation_is():
    datapath, _ = datapaths(Parameters())
    rows = {row.name: row for row in rows_of(datapath.schedule, QUANTITIES, FETCHED)}
    for name in ("d", "stretch", "trial", "net", "slope"):
        ends = [end for n, _, _, end in datapath.schedule.stages() if n.removesuffix("_x") == name]
        assert rows[name].done == FETCHED + max(ends)
    assert rows["pull"].done == cycles(Parameters())["edge", "issue to its force on both nodes"]


def test_the_lane_ends_with_the_table_of_latencies():
    *_, sums, written = [text for text in words(lane(Parameters())) if re.fullmatch(r"\d+", text) and int(text) % 10]
    table = cycles(Parameters())
    assert int(sums) == table[SUMS]
    assert int(written) == table[WRITTEN]


def schedule(*names):
    return SimpleNamespace(stages=lambda: [(name, "add", 2, 3) for name in names])


def test_the_longest_name_that_fits_owns_an_operation():
    short, long = rows_of(schedule("s_mul", "s_shift_add"), [("s", "", ("s",)), ("shift", "", ("s_shift",))], 10)
    assert short.spans == long.spans == [("sum", 12, 13)]


def test_an_operation_of_no_quantity_is_refused():
    with pytest.raises(
        ValueError, match="the operation new_add must belong to a quantity of the chart, but belongs to none"
    ):
        rows_of(schedule("s", "new_add"), [("s", "", ("s",))], 0)


def test_a_quantity_without_operations_is_refused():
    with pytest.raises(ValueError, match="the chart's quantity t must have operations, but has none"):
        rows_of(schedule("s"), [("s", "", ("s",)), ("t", "", ("t",))], 0)
