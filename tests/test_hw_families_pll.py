"""PLLs: the dividers against the closed form and the limits, clocks that none gives, and the modules' text."""

import re
from fractions import Fraction

import pytest

from golden.support.errors import InputError
from hw.families import no_pll as none
from hw.families.ecp5 import pll as ecp5
from hw.families.pll import Dividers
from hw.families.xilinx import pll as xilinx

FAMILIES = {"ecp5": ecp5, "xilinx": xilinx}


@pytest.mark.parametrize(
    ("family", "oscillator", "clock", "dividers"),
    [
        ("ecp5", 25, 100, (1, 24, 6)),
        ("ecp5", 25, 120, (1, 24, 5)),
        ("ecp5", 25, 112.5, (1, 27, 6)),
        ("ecp5", 48, 72, (1, 12, 8)),
        ("ecp5", 12, 60, (1, 50, 10)),
        ("xilinx", 100, 100, (1, 12, 12)),
        ("xilinx", 100, 120, (1, 12, 10)),
        ("xilinx", 27, 54, (1, 44, 22)),
    ],
)
def test_dividers(family, oscillator, clock, dividers):
    found = FAMILIES[family].LIMITS.dividers(oscillator, clock)
    assert found == Dividers(*dividers)
    assert Fraction(oscillator) * found.multiply / (found.divide * found.output) == Fraction(clock)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("oscillator", [19.2, 25, 100, 400])
def test_all_that_is_possible_is_within_the_limits(family, oscillator):
    limits, count = FAMILIES[family].LIMITS, 0
    for d in limits.possible(oscillator):
        count += 1
        for value, (least, most) in (
            (d.divide, limits.divide),
            (d.multiply, limits.multiply),
            (d.output, limits.output),
            (oscillator / d.divide, limits.phase),
            (d.oscillation(oscillator), limits.oscillation),
            (d.mhz(oscillator), limits.clock),
        ):
            assert least <= value <= most
    assert count > 500


def test_the_ecp5_oscillates_at_400_to_800_mhz():
    assert ecp5.LIMITS.oscillation == (400, 800)


@pytest.mark.parametrize(
    ("family", "oscillator", "clock", "message"),
    [
        (
            "ecp5",
            25,
            137.3,
            "clock_mhz must be a frequency that a PLL of ecp5 makes of 25 MHz, as 135 or 137.5, not 137.3",
        ),
        ("ecp5", 25, 1000, "clock_mhz must be a frequency that a PLL of ecp5 makes of 25 MHz, as 400, not 1000"),
        ("ecp5", 25, 1, "clock_mhz must be a frequency that a PLL of ecp5 makes of 25 MHz, as 3.14960630, not 1"),
        ("ecp5", 5, 100, "oscillator_mhz must be 8 to 400 for a PLL of ecp5, not 5"),
        ("xilinx", 12, 100, "oscillator_mhz must be 19 to 800 for a PLL of xilinx, not 12"),
    ],
)
def test_a_clock_that_none_gives_is_refused_with_those_near(family, oscillator, clock, message):
    if clock == 1:
        near = min(d.mhz(oscillator) for d in ecp5.LIMITS.possible(oscillator))
        message = message.replace("3.14960630", f"{near:.9g}")
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        FAMILIES[family].verilog("clock", oscillator, clock)


def test_what_is_near_would_do():
    for clock in (135, 137.5):
        assert ecp5.LIMITS.dividers(25, clock).mhz(25) == clock


def test_the_text_has_the_dividers_and_says_what_it_gives():
    text, mhz = ecp5.verilog("clock", 25, 120)
    assert mhz == 120 and "module clock(input oscillator, output clock, output locked);" in text
    assert ".CLKI_DIV(1), .CLKFB_DIV(24)," in text and ".CLKOP_DIV(5), .CLKOP_CPHASE(4)" in text
    assert '(* FREQUENCY_PIN_CLKI = "25" *) (* FREQUENCY_PIN_CLKOP = "120" *)' in text
    text, mhz = xilinx.verilog("clock", 100, 120)
    assert mhz == 120 and ".CLKIN1_PERIOD(10.000), .DIVCLK_DIVIDE(1), .CLKFBOUT_MULT(12), .CLKOUT0_DIVIDE(10)" in text


def test_without_a_pll_there_is_the_oscillators_clock():
    text, mhz = none.verilog("clock", 50, 50)
    assert mhz == 50 and "assign clock = oscillator;" in text
    message = "clock_mhz must be the oscillator's 50 without a PLL, not 60"
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        none.verilog("clock", 50, 60)
