"""Blocks of Gowin primitives: multipliers, which Yosys doesn't infer for the GW5A; block RAMs it infers.

``models.v``, beside this file, has a behavioural model of the primitive.
"""

from amaranth.hdl import Cat, ClockSignal, Const, Instance, Module, Signal

from hw.blocks.multiplier import WIDTH
from hw.families.family import Blocks

A_BITS, B_BITS, PRODUCT_BITS = 27, 36, 63
"""Widths of a MULT27X36, all signed."""


class GowinBlocks(Blocks):
    def get_multiplier(self, multiplier) -> Module | None:
        """A MULT27X36 between registers of the fabric: the open tools can't configure those inside the block."""
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
    """Return the operand with its sign or with zeros above it."""
    above = operand[-1] if operand.shape().signed else Const(0, 1)
    return Cat(operand, above.replicate(bits - len(operand)))
