"""A short queue, in lookup tables."""

from amaranth.hdl import Module, Signal
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out


class Queue(wiring.Component):
    """First in, first out. A word appears in the cycle after it was put in, when those before it have been taken.

    Parameters
    ----------
    width, depth : int
        Whoever puts words in sees to it that there are never more than ``depth``, a power of two.

    Members
    -------
    flush : In(1)
        Empty it.
    put : In(1), data_in : In
    valid : Out(1), take : In(1), data : Out
        There is a word, it is taken. ``take`` only while ``valid``.

    Raises
    ------
    ValueError
        If the depth is not a power of two of at least 2.
    """

    def __init__(self, *, width: int, depth: int):
        if depth < 2 or depth & depth - 1:
            raise ValueError(f"depth must be a power of two of at least 2, not {depth!r}")
        self.kind = f"queue_{depth}x{width}"
        self.depth = depth
        super().__init__(
            {
                "flush": In(1),
                "put": In(1),
                "data_in": In(width),
                "valid": Out(1),
                "take": In(1),
                "data": Out(width),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.words = words = memory.Memory(shape=len(self.data), depth=self.depth, init=())
        write, read = words.write_port(), words.read_port(domain="comb")
        level = Signal(range(self.depth + 1))
        m.d.comb += [
            write.en.eq(self.put),
            write.data.eq(self.data_in),
            self.data.eq(read.data),
            self.valid.eq(level != 0),
        ]
        for port, moves in ((write, self.put), (read, self.take)):
            place = Signal(range(self.depth), name="next_in" if port is write else "next_out")
            m.d.comb += port.addr.eq(place)
            with m.If(self.flush):
                m.d.sync += place.eq(0)
            with m.Elif(moves):
                m.d.sync += place.eq(place + 1)
        with m.If(self.flush):
            m.d.sync += level.eq(0)
        with m.Else():
            m.d.sync += level.eq(level + self.put - self.take)
        return m
