"""The circuits that can be made: impossible ones are refused by name, the largest fits its records and addresses."""

from functools import partial

import pytest
from hw_objects import refused

from golden.datapath import records
from golden.datapath.formats import Formats
from hw.map.control import Control
from hw.map.memory_map import ADDRESS, Map, Region, join
from hw.parameters import Parameters
from hw.sizes import format_sizes

RANGES = {
    "lanes": (1, 8),
    "updates": (1, 2),
    "nodes": (2, 4096),
    "edges": (1, 65536),
    "materials": (1, 64),
    "tables": (1, 16),
}
LARGEST = Parameters(**{name: high for name, (_, high) in RANGES.items()})
SMALLEST = Parameters(**{name: low for name, (low, _) in RANGES.items()})
EXAMPLES = [Parameters(), SMALLEST, LARGEST, Parameters(lanes=3, nodes=100, edges=1000), Parameters(lanes=8, edges=1)]


@pytest.mark.parametrize("name", RANGES)
def test_each_end_of_a_range_is_legal_and_nothing_beyond(name):
    low, high = RANGES[name]
    for value in (low, high):
        Parameters(**{name: value})
    allowed = f"a whole number from {low} to {high}" if high - low > 1 else f"{low} or {high}"
    for value in (low - 1, high + 1, 1.0, "4", None):
        refused(partial(Parameters, **{name: value}), f"{name} must be {allowed}, not {value!r}")


@pytest.mark.parametrize("axes", [0, 2, 4, 1.0, "3", None])
def test_an_updater_takes_one_axis_or_all(axes):
    refused(lambda: Parameters(axes=axes), f"axes must be 1 or 3, not {axes!r}")


def test_an_updater_takes_a_cycle_for_each_share_of_a_nodes_axes():
    assert (Parameters(axes=3).cycles_per_node, Parameters(axes=1).cycles_per_node) == (1, 3)
    circuits = [Parameters(updates=updates, axes=axes) for updates in (1, 2) for axes in (3, 1)]
    assert [format_sizes(circuit)["updates"] for circuit in circuits] == ["1", "1/3", "2", "2/3"]


@pytest.mark.parametrize("family", ["x", "ECP5", "", None])
def test_a_family_that_nobody_knows(family):
    refused(lambda: Parameters(family=family), f"family must be ecp5 or generic or gowin or xilinx, not {family!r}")


def test_a_list_entry_fits_a_state_word():
    Parameters(formats=Formats(16, 34))
    refused(
        lambda: Parameters(formats=Formats(16, 33)), "state must be at least 34 bits, as a list's entry has, not 33"
    )


@pytest.mark.parametrize("p", EXAMPLES, ids=str)
def test_entries_hold_every_number(p):
    edge, node = records.edge_entry(), records.node_entry()
    assert p.nodes - 1 <= edge["i"].raw_max and p.nodes - 1 <= edge["j"].raw_max
    assert p.materials - 1 <= edge["material"].raw_max
    assert p.rows <= node["need"].raw_max
    assert 2 * p.lanes <= node["mask"].width


@pytest.mark.parametrize("p", EXAMPLES, ids=str)
def test_addresses_reach_every_word(p):
    memory = Map(p)
    assert len(Region) - 1 <= ADDRESS["region"].raw_max and ADDRESS.width <= 32
    for region in Region:
        assert memory.depth(region) - 1 <= ADDRESS["index"].raw_max
        assert len(memory.words(region)) - 1 <= ADDRESS["word"].raw_max
        assert memory.lanes(region) - 1 <= ADDRESS["lane"].raw_max
        if region != Region.CONTROL:
            assert memory.depth(region) <= 1 << p.index_bits


@pytest.mark.parametrize("p", EXAMPLES, ids=str)
def test_derived_numbers(p):
    assert p.rows * p.lanes >= p.edges > (p.rows - 1) * p.lanes
    for bits, count in ((p.row_bits, p.rows), (p.node_bits, p.nodes), (p.material_bits, p.materials)):
        assert bits == max(1, (count - 1).bit_length())


@pytest.mark.parametrize("p", EXAMPLES, ids=str)
@pytest.mark.parametrize("region", Region)
def test_every_word_says_what_it_holds_and_fits(p, region):
    memory = Map(p)
    for word in memory.words(region):
        fields = memory.fields(region, word)
        assert fields and fields.width <= p.formats.state, word


def test_only_results_are_read_only():
    memory = Map(Parameters())
    words = [(region, word) for region in Region for word in memory.words(region) if memory.read_only(region, word)]
    assert words == [(Region.NODE, f"force_{axis}") for axis in "xyz"]


def test_addresses_are_all_different():
    memory = Map(SMALLEST)
    places = [
        (region, word, index, lane)
        for region in Region
        for word in range(len(memory.words(region)))
        for index in range(memory.depth(region))
        for lane in range(memory.lanes(region))
    ]
    assert len({memory.address(*place) for place in places}) == len(places)
    assert all(memory.address(*place) == join(*place) < 1 << ADDRESS.width for place in places)


def test_a_word_may_be_named():
    memory = Map(Parameters())
    assert memory.address(Region.EDGE, "ratio", 5, 2) == memory.address(Region.EDGE, 2, 5, 2)
    assert memory.address(Region.CONTROL, 0, Control.RUN) == Control.RUN


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ((Region.NODE, 14), "NODE word must be below 14, not 14"),
        ((Region.EDGE, 0, 1024), "EDGE index must be below 1024, not 1024"),
        ((Region.EDGE, 0, -1), "EDGE index must be below 1024, not -1"),
        ((Region.MATERIAL, 0, 0, 4), "MATERIAL lane must be below 4, not 4"),
        ((Region.NODE, 0, 0, 1), "NODE lane must be below 1, not 1"),
        ((Region.CONTROL, 0, 24), "CONTROL index must be below 24, not 24"),
    ],
)
def test_there_is_no_address_of_nothing(place, message):
    refused(lambda: Map(Parameters()).address(*place), message)
