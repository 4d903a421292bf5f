"""No PLL, where the open tools know none of the device: the oscillator's clock is the circuit's."""

from golden.support.errors import InputError

VERILOG = """module {name}(input oscillator, output clock, output locked);
  assign clock = oscillator;
  assign locked = 1'b1;
endmodule
"""


def verilog(name: str, oscillator_mhz: float, clock_mhz: float) -> tuple[str, float]:
    """(the module ``name`` with the ports oscillator, clock and locked, the clock that it gives in MHz)

    Raises `InputError` for a clock that is not the oscillator's.
    """
    if clock_mhz != oscillator_mhz:
        raise InputError(f"clock_mhz must be the oscillator's {oscillator_mhz:g} without a PLL, not {clock_mhz:g}")
    return VERILOG.format(name=name), oscillator_mhz
