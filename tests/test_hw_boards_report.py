"""Reports of place and route: resources, clock, critical path, names."""

import pytest
from board_objects import PATH, STATISTICS, STEPS, TIMED, reported

from hw.boards import flow, report
from hw.families.registry import get_family
from hw.families.resources import Resources

ECP5 = get_family("ecp5").flow


def test_resources_leave_the_frame_out():
    synthesised, frame = flow._without_frame(STATISTICS, ECP5)
    assert synthesised == Resources(lut=1620, ff=2000, multipliers=23, block_rams=13, lut_ram=20)
    assert frame == Resources(lut=39, ff=106, multipliers=0, block_rams=0, lut_ram=0)
    assert report.placed(reported(100), ECP5) - frame == TIMED


def test_the_critical_path_is_from_register_to_register():
    assert report.critical_path(reported(100), ECP5) == STEPS


def test_a_path_that_starts_in_a_cell_of_the_tool_has_only_names_of_the_design():
    first, *others = STEPS
    path = [("clk-to-q", 0.25, "$PACKER_VCC_NET"), *PATH]
    assert report.critical_path(reported(100, path), ECP5) == [report.Step(first.name, first.ns + 0.25), *others]


@pytest.mark.parametrize(
    "cell, name",
    [
        ("core.lane0.edge.multiplier_3.product_1_TRELLIS_FF_Q_12", "lane0.edge.multiplier_3.product_1"),
        ("core.sequencer.nodes_over_LUT4_B_Z_LUT4_Z", "sequencer.nodes_over"),
        ("core.sequencer.summed_TRELLIS_FF_Q_11_DI_LUT4_Z_C_CCU2C_S1_S0_CCU2C_S0", "sequencer.summed"),
        ("core.lane0.ram.words.0.0_DOB10", "lane0.ram.words"),
        ("core.lane0.ram.words.0.0", "lane0.ram.words"),
        ("core.updater0.stage__double_ring7.words[2]_TRELLIS_FF_Q_1", "updater0.stage__double_ring7.words"),
        ("core.m3.product_MULT18X18D_P0", "m3.product"),
        ("core.lane0.t12_next", "lane0.t12_next"),
        ("gathered_TRELLIS_FF_Q_3", "gathered"),
        ("$nextpnr_CCU2C_241$CCU2_COMB0", ""),
    ],
)
def test_names_are_the_designs_own(cell, name):
    assert report.signal_name(cell, ECP5) == name
