"""A stage of a shifter: lookup tables that choose one of four."""

from amaranth.hdl import Cat, Const, Module, Mux, Value, unsigned
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out


class ShiftStage(wiring.Component):
    """A number shifted by ``times`` x ``places`` bits; combinational.

    Bits that are shifted out are lost. A shift to the left fills with zeros, one to the right with copies of the sign.

    Parameters
    ----------
    shape : Shape
        The number's.
    bits : int
        Bits of ``times``, 1 or 2.
    places : int
        Bits of the shift for each of ``times``.
    left : bool
        The direction.

    Members
    -------
    i : In, o : Out
    times : In(bits)
    """

    def __init__(self, shape, bits: int, places: int, *, left: bool):
        self.places, self.left = places, left
        side = "left" if left else "right"
        self.kind = f"shift_{side}_{'1' if bits == 1 else '3'}x{places}_{'s' if shape.signed else 'u'}{shape.width}"
        super().__init__({"i": In(shape), "times": In(bits), "o": Out(unsigned(shape.width))})

    def source(self, bit: int, times: int) -> Value | None:
        """Return the input bit that becomes an output bit; None for a zero."""
        place = bit - times * self.places if self.left else bit + times * self.places
        if 0 <= place < len(self.i):
            return self.i[place]
        return self.i[-1] if self.i.shape().signed and not self.left else None

    def elaborate(self, platform):
        block = platform.get_shift_stage(self) if hasattr(platform, "get_shift_stage") else None
        return block or self._generic()

    def _generic(self):
        m = Module()
        zero = Const(0, 1)
        moved = []
        for times in range(1 << len(self.times)):
            sources = [self.source(n, times) for n in range(len(self.i))]
            moved.append(Cat(zero if bit is None else bit for bit in sources))
        for bit in self.times:
            moved = [Mux(bit, further, unmoved) for unmoved, further in zip(moved[::2], moved[1::2], strict=True)]
        m.d.comb += self.o.eq(moved[0])
        return m
