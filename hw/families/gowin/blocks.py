"""Gowin Arora V (GW5A): multipliers, which Yosys doesn't find for this family. Block RAMs it finds by itself.

``gowin.v``, beside this file, has a behavioural model of what is used here.
"""

from amaranth.hdl import Cat, ClockSignal, Const, Instance, Module, Signal

from hw.blocks.multiplier import WIDTH

A_BITS, B_BITS, PRODUCT_BITS = 27, 36, 63
"""Of a MULT27X36, all signed."""


class Gowin:
    """Modules with primitives for the blocks of `hw.blocks`, as `hw.families.ecp5.blocks.Ecp5`."""

    def get_multiplier(self, multiplier) -> Module | None:
        """A MULT27X36 between registers of the fabric: the tools don't write those inside of this device."""
        operands = multiplier.a, multiplier.b
        if max(map(len, operands)) > WIDTH:
            return None
        m = Module()
        inside = [
            Signal(operand.shape(), name=f"{name}_in", reset_less=True)
            for name, operand in zip("ab", operands, strict=True)
        ]
        m.d.sync += [register.eq(operand) for register, operand in zip(inside, operands, strict=True)]
        a, b = (_extended(register, bits) for register, bits in zip(inside, (A_BITS, B_BITS), strict=True))
        out = Signal(PRODUCT_BITS, name="out")
        m.submodules.block = Instance(
            "MULT27X36",
            i_A=a, i_B=b, i_D=Const(0, 26), i_CLK=Cat(ClockSignal(), Const(0)), i_CE=Const(0, 2), i_RESET=Const(0, 2),
            i_PSEL=Const(0), i_PADDSUB=Const(0), o_DOUT=out,
        )  # fmt: skip
        product = out[: len(multiplier.product)]
        for number in range(1, multiplier.registers):
            register = Signal(len(multiplier.product), name=f"product_{number}", reset_less=True)
            m.d.sync += register.eq(product)
            product = register
        m.d.comb += multiplier.product.eq(product)
        return m


def _extended(operand: Signal, bits: int):
    above = operand[-1] if operand.shape().signed else Const(0, 1)
    return Cat(operand, above.replicate(bits - len(operand)))
