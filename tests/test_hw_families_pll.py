"""PLLs: the dividers against the closed form and the limits, clocks that are refused, and the modules' text."""

import re
from fractions import Fraction

import pytest

from golden.support.errors import InputError
from hw.families.pll import Dividers, NoPll
from hw.families.registry import family_names, get_family

FAMILIES = [name for name in family_names() if not isinstance(get_family(name).pll, NoPll)]
ECP5, XILINX = get_family("ecp5").pll, get_family("xilinx").pll


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
    found = get_family(family).pll.dividers(oscillator, clock)
    assert found == Dividers(*dividers)
    assert Fraction(oscillator) * found.multiply / (found.divide * found.output) == Fraction(clock)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("oscillator", [19.2, 25, 100, 400])
def test_all_dividers_are_within_the_limits(family, oscillator):
    limits, count = get_family(family).pll, 0
    for d in limits.all_dividers(oscillator):
        count += 1
        for value, (least, most) in (
            (d.divide, limits.divide),
            (d.multiply, limits.multiply),
            (d.output, limits.output),
            (oscillator / d.divide, limits.phase_detector),
            (d.vco(oscillator), limits.vco),
            (d.mhz(oscillator), limits.clock),
        ):
            assert least <= value <= most
    assert count > 500


def test_the_ecp5s_vco_runs_at_400_to_800_mhz():
    assert ECP5.vco == (400, 800)


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
def test_an_impossible_clock_is_refused_with_the_nearest(family, oscillator, clock, message):
    if clock == 1:
        nearest = min(d.mhz(oscillator) for d in ECP5.all_dividers(oscillator))
        message = message.replace("3.14960630", f"{nearest:.9g}")
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        get_family(family).pll.verilog("clock", oscillator, clock)


def test_the_nearest_clocks_are_possible():
    for clock in (135, 137.5):
        assert ECP5.dividers(25, clock).mhz(25) == clock


def test_the_text_has_the_dividers_and_the_clock_is_returned():
    text, mhz = ECP5.verilog("clock", 25, 120)
    assert mhz == 120 and "module clock(input oscillator, output clock, output locked);" in text
    assert ".CLKI_DIV(1), .CLKFB_DIV(24)," in text and ".CLKOP_DIV(5), .CLKOP_CPHASE(4)" in text
    assert '(* FREQUENCY_PIN_CLKI = "25" *) (* FREQUENCY_PIN_CLKOP = "120" *)' in text
    text, mhz = XILINX.verilog("clock", 100, 120)
    assert mhz == 120 and ".CLKIN1_PERIOD(10.000), .DIVCLK_DIVIDE(1), .CLKFBOUT_MULT(12), .CLKOUT0_DIVIDE(10)" in text


def test_without_a_pll_there_is_the_oscillators_clock():
    text, mhz = NoPll().verilog("clock", 50, 50)
    assert mhz == 50 and "assign clock = oscillator;" in text
    message = "clock_mhz must be the oscillator's 50 without a PLL, not 60"
    with pytest.raises(InputError, match=f"^{re.escape(message)}$"):
        NoPll().verilog("clock", 50, 60)
