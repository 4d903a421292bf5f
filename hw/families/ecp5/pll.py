"""The ECP5's EHXPLLL. Its last output, undivided, is the feedback, so that the clock has a divider of its own."""

from hw.families.pll import Pll

# The attributes are the loop's filter. They and the feedback are those of LiteX's ECP5PLL, which runs on the ULX3S
TEMPLATE = """module {name}(input oscillator, output clock, output locked);
  (* FREQUENCY_PIN_CLKI = "{oscillator:g}" *) (* FREQUENCY_PIN_CLKOP = "{mhz:g}" *)
  (* ICP_CURRENT = "6" *) (* LPF_RESISTOR = "16" *) (* MFG_ENABLE_FILTEROPAMP = "1" *) (* MFG_GMCREF_SEL = "2" *)
  EHXPLLL #(
    .CLKI_DIV({d.divide}), .CLKFB_DIV({d.multiply}), .FEEDBK_PATH("INT_OS3"),
    .CLKOP_ENABLE("ENABLED"), .CLKOP_DIV({d.output}), .CLKOP_CPHASE({phase}), .CLKOP_FPHASE(0),
    .CLKOS3_ENABLE("ENABLED"), .CLKOS3_DIV(1), .CLKOS3_CPHASE(23), .CLKOS3_FPHASE(0)
  ) pll (.RST(1'b0), .CLKI(oscillator), .CLKOP(clock), .LOCK(locked));
endmodule
"""

# From LiteX and Project Trellis's ecppll, which both have them from the data sheet, FPGA-DS-02012, "sysCLOCK PLL
# Timing"; except for the slowest phase detector: ecppll takes 3.125 MHz, which the data sheet, as remembered, doesn't
# allow
PLL = Pll(
    family="ecp5", oscillator=(8, 400), phase_detector=(10, 400), vco=(400, 800), clock=(3.125, 400),
    divide=(1, 128), multiply=(1, 80), output=(1, 128), template=TEMPLATE,
)  # fmt: skip
