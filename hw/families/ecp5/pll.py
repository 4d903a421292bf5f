"""The ECP5's EHXPLLL. Its last output, not divided, is fed back inside, so that the clock has a divider of its own."""

from hw.families.pll import Limits

# As LiteX and Project Trellis's ecppll have them, both from the data sheet, FPGA-DS-02012, "sysCLOCK PLL Timing"; but
# for the slowest comparison of phases: ecppll takes 3.125 MHz, which the data sheet, as remembered, doesn't allow
LIMITS = Limits(
    "ecp5", oscillator=(8, 400), phase=(10, 400), oscillation=(400, 800), clock=(3.125, 400),
    divide=(1, 128), multiply=(1, 80), output=(1, 128),
)  # fmt: skip

# The attributes are the loop's filter. These and the feedback are those of LiteX's ECP5PLL, which runs on this board
VERILOG = """module {name}(input oscillator, output clock, output locked);
  (* FREQUENCY_PIN_CLKI = "{oscillator:g}" *) (* FREQUENCY_PIN_CLKOP = "{mhz:g}" *)
  (* ICP_CURRENT = "6" *) (* LPF_RESISTOR = "16" *) (* MFG_ENABLE_FILTEROPAMP = "1" *) (* MFG_GMCREF_SEL = "2" *)
  EHXPLLL #(
    .CLKI_DIV({d.divide}), .CLKFB_DIV({d.multiply}), .FEEDBK_PATH("INT_OS3"),
    .CLKOP_ENABLE("ENABLED"), .CLKOP_DIV({d.output}), .CLKOP_CPHASE({phase}), .CLKOP_FPHASE(0),
    .CLKOS3_ENABLE("ENABLED"), .CLKOS3_DIV(1), .CLKOS3_CPHASE(23), .CLKOS3_FPHASE(0)
  ) pll (.RST(1'b0), .CLKI(oscillator), .CLKOP(clock), .LOCK(locked));
endmodule
"""


def verilog(name: str, oscillator_mhz: float, clock_mhz: float) -> tuple[str, float]:
    """(the module ``name`` with the ports oscillator, clock and locked, the clock that it gives in MHz)

    Raises `InputError` for a clock that can't be made.
    """
    d = LIMITS.dividers(oscillator_mhz, clock_mhz)
    mhz = d.mhz(oscillator_mhz)
    return VERILOG.format(name=name, oscillator=oscillator_mhz, mhz=mhz, d=d, phase=d.output - 1), mhz
