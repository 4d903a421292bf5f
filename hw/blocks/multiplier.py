"""A multiplier with its registers: one DSP block."""

from amaranth.hdl import Cat, Module, Shape, Signal, signed
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

WIDTH = 18
"""Operand bits of one DSP multiplier."""


class Multiplier(wiring.Component):
    """Exact product of two numbers, each signed or unsigned, of at most 18 bits on one multiplier.

    Latency ``registers`` cycles (one at the inputs, the rest after the product), throughput one product a cycle. A
    wider operand is legal and takes more multipliers.

    Tools map a product of equal signedness to one block. A full-width unsigned operand ``u`` beside a signed one is
    therefore taken as ``u - 2**17``, which is signed and 18 bits wide, and corrected by one addition. A family makes
    its own module of it, if it has multipliers (``get_multiplier`` of Amaranth's ``platform``).

    Parameters
    ----------
    a, b : Shape
        The operands' shapes.
    registers : int
        At least 2.
    apart : bool
        The last register, of three or more, may be placed where the product is used instead of in the block.

    Members
    -------
    a, b : In
    product : Out, wide enough for every product

    Raises
    ------
    ValueError
        If there are fewer than 2 registers.
    """

    def __init__(self, a, b, *, registers: int, apart: bool = False):
        if registers < 2:
            raise ValueError(f"registers must be at least 2, not {registers!r}")
        self.registers, self.apart = registers, apart and registers > 2
        a, b = Shape.cast(a), Shape.cast(b)
        self.kind = f"multiplier_{letter(a)}{a.width}_{letter(b)}{b.width}" + "_apart" * self.apart
        product = Shape(a.width + b.width, a.signed or b.signed)
        super().__init__({"a": In(a), "b": In(b), "product": Out(product)})

    def elaborate(self, platform):
        block = platform.get_multiplier(self) if hasattr(platform, "get_multiplier") else None
        return block or self._generic()

    def _generic(self):
        m = Module()
        a, b = (self.a, self.b) if self.a.shape().signed else (self.b, self.a)
        wide = len(b) >= WIDTH and a.shape().signed and not b.shape().signed
        top = len(b) - 1
        offset = Cat(b[:top], ~b[top]).as_signed() if wide else b
        a_in = Signal(a.shape(), reset_less=True)
        b_in = Signal(offset.shape(), reset_less=True)
        m.d.sync += [a_in.eq(a), b_in.eq(offset)]

        raw = a_in * b_in
        correction = (a_in << top) if wide else None
        if wide and self.registers > 2:
            raw_out = Signal(signed(len(a) + len(b)), reset_less=True)
            correction_out = Signal(signed(len(a) + top), reset_less=True)
            m.d.sync += [raw_out.eq(raw), correction_out.eq(correction)]
            raw, correction = raw_out, correction_out
        value = raw + correction if wide else raw
        for number in range(self.registers - (2 if wide and self.registers > 2 else 1)):
            out = Signal(self.product.shape(), name=f"product_{number + 1}", reset_less=True)
            m.d.sync += out.eq(value)
            value = out
        m.d.comb += self.product.eq(value)
        return m


def letter(shape: Shape) -> str:
    """Return the letter for an operand in a kind's name: signed or unsigned."""
    return "s" if shape.signed else "u"
