"""The 7 series' PLLE2_BASE."""

from hw.families.pll import Limits

# For the slowest speed grade: oscillator, comparison of phases and oscillation as others quote the data sheet, DS181
# (table 38, "PLL Specification"), multiplier and output divider as UG953 has them. From memory: the other divider, and
# 464 MHz, which a global buffer takes, where the PLL gives more. The vendor's tool refuses what it can't make
LIMITS = Limits(
    "xilinx", oscillator=(19, 800), phase=(19, 450), oscillation=(800, 1600), clock=(6.25, 464),
    divide=(1, 56), multiply=(2, 64), output=(1, 128),
)  # fmt: skip

VERILOG = """module {name}(input oscillator, output clock, output locked);
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


def verilog(name: str, oscillator_mhz: float, clock_mhz: float) -> tuple[str, float]:
    """(the module ``name`` with the ports oscillator, clock and locked, the clock that it gives in MHz)

    Raises `InputError` for a clock that can't be made.
    """
    d = LIMITS.dividers(oscillator_mhz, clock_mhz)
    return VERILOG.format(name=name, period=1000 / oscillator_mhz, d=d), d.mhz(oscillator_mhz)
