"""A multiplier for a narrow operand: an adder tree, which needs no DSP block."""

from amaranth.hdl import Module, Mux, Shape, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.multiplier import letter


def levels(bits: int) -> int:
    """Return the levels of two-operand sums for one row for each bit."""
    return (bits - 1).bit_length()


class NarrowMultiplier(wiring.Component):
    """Exact product of a number and a narrow unsigned one, from lookup tables.

    Latency ``registers`` cycles: one after each level of sums, those left over after the product. Throughput one
    product a cycle.

    Parameters
    ----------
    a, b : Shape
        The operands' shapes; ``b`` is the narrow one.
    registers : int
        At least 1 and at least `levels` of ``b``'s bits.

    Members
    -------
    a, b : In
    product : Out, wide enough for every product

    Raises
    ------
    ValueError
        If ``b`` is signed, or there are too few registers.
    """

    def __init__(self, a, b, *, registers: int):
        a, b = Shape.cast(a), Shape.cast(b)
        if b.signed:
            raise ValueError(f"the narrow operand must be unsigned, not {b!r}")
        if registers < (least := max(1, levels(b.width))):
            raise ValueError(f"registers must be at least {least}, not {registers!r}")
        self.registers = registers
        self.kind = f"narrow_multiplier_{letter(a)}{a.width}_{b.width}"
        super().__init__({"a": In(a), "b": In(b), "product": Out(Shape(a.width + b.width, a.signed))})

    def elaborate(self, platform):
        m = Module()
        rows = [Mux(bit, self.a, 0) << number for number, bit in enumerate(self.b)]
        for level in range(self.registers):
            sums = [sum(rows[first : first + 2]) for first in range(0, len(rows), 2)]
            rows = [
                Signal(Shape.cast(row.shape()), name=f"sum_{level}_{n}", reset_less=True) for n, row in enumerate(sums)
            ]
            m.d.sync += [row.eq(value) for row, value in zip(rows, sums, strict=True)]
        m.d.comb += self.product.eq(rows[0])
        return m
