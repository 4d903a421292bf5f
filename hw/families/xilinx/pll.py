"""The 7 series' PLLE2_BASE."""

from hw.families.pll import Pll

TEMPLATE = """module {name}(input oscillator, output clock, output locked);
  wire feedback, out;
  PLLE2_BASE #(
    .CLKIN1_PERIOD({period:.3f}), .DIVCLK_DIVIDE({d.divide}), .CLKFBOUT_MULT({d.multiply}), .CLKOUT0_DIVIDE({d.output})
  ) pll (
    .CLKIN1(oscillator), .CLKFBIN(feedback), .CLKFBOUT(feedback), .CLKOUT0(out), .LOCKED(locked), .PWRDWN(1'b0),
    .RST(1'b0)
  );
  BUFG buffer(.I(out), .O(clock));
endmodule
"""

# For the slowest speed grade: oscillator, phase detector and VCO as others quote the data sheet, DS181 (table 38, "PLL
# Specification"); multiplier and output divider as UG953 has them. From memory: the input divider, and 464 MHz, the
# limit of a global buffer, which is below the PLL's. Vivado refuses dividers that the device doesn't have
PLL = Pll(
    family="xilinx", oscillator=(19, 800), phase_detector=(19, 450), vco=(800, 1600), clock=(6.25, 464),
    divide=(1, 56), multiply=(2, 64), output=(1, 128), template=TEMPLATE,
)  # fmt: skip
