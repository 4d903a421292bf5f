"""A short queue: lookup tables behind a register."""

from amaranth.hdl import Module, Mux, Signal
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
        places = [Signal(range(self.depth), name=name) for name in ("next_in", "next_out")]
        # A word stands in front of the memory, in a register: the memory is never full, and what is written to its free
        # place in cycles in which nothing is put in there is written over later. Whether words wait in it is known from
        # a register too: all of the word in front hangs on it
        moves, waiting, passes = Signal(), Signal(), Signal()
        store, fetch, single = Signal(), Signal(), Signal()
        m.d.comb += [
            moves.eq(~self.valid | self.take),
            single.eq(places[0] == (places[1] + 1)[: len(places[1])]),
            passes.eq(moves & ~waiting),
            store.eq(self.put & ~passes),
            fetch.eq(moves & waiting),
            write.en.eq(1),
            write.data.eq(self.data_in),
        ]
        with m.If(moves):
            m.d.sync += [self.data.eq(Mux(waiting, read.data, self.data_in)), self.valid.eq(waiting | self.put)]
        m.d.sync += waiting.eq(store | waiting & ~(fetch & single))
        for port, place, steps in ((write, places[0], store), (read, places[1], fetch)):
            m.d.comb += port.addr.eq(place)
            m.d.sync += place.eq(place + steps)
            with m.If(self.flush):
                m.d.sync += place.eq(0)
        with m.If(self.flush):
            m.d.sync += [self.valid.eq(0), waiting.eq(0)]
        return m
