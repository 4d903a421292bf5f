"""A short queue: a memory of lookup tables, and a register for the word that is next."""

from amaranth.hdl import Module, Mux, Signal
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

LATENCY = 1
"""Cycles from a word that is put into an empty queue to the word at its end, which is a register."""


class Queue(wiring.Component):
    """First in, first out. A word appears `LATENCY` cycles after it was put, once those before it have been taken. A
    word can be put and one taken in every cycle.

    Parameters
    ----------
    width, depth : int
        It must never hold more words than ``depth``, a power of two.

    Members
    -------
    flush : In(1)
        Empty it.
    put : In(1), data_in : In
    valid : Out(1), take : In(1), data : Out
        The next word; ``take`` removes it, only while ``valid``.

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
        write = words.write_port()
        read = words.read_port(domain="comb")
        addresses = [Signal(range(self.depth), name=name) for name in ("next_in", "next_out")]
        # The next word is in a register, so the memory is never full, and its write port is always enabled: a word that
        # was not put is overwritten later. ``waiting`` is a register too, because its fan-out is the whole next word
        advances = Signal()
        waiting = Signal()
        passes = Signal()
        store = Signal()
        fetch = Signal()
        single = Signal()
        m.d.comb += [
            advances.eq(~self.valid | self.take),
            single.eq(addresses[0] == (addresses[1] + 1)[: len(addresses[1])]),
            passes.eq(advances & ~waiting),
            store.eq(self.put & ~passes),
            fetch.eq(advances & waiting),
            write.en.eq(1),
            write.data.eq(self.data_in),
        ]
        with m.If(advances):
            m.d.sync += [self.data.eq(Mux(waiting, read.data, self.data_in)), self.valid.eq(waiting | self.put)]
        m.d.sync += waiting.eq(store | waiting & ~(fetch & single))
        for port, address, steps in ((write, addresses[0], store), (read, addresses[1], fetch)):
            m.d.comb += port.addr.eq(address)
            m.d.sync += address.eq(address + steps)
            with m.If(self.flush):
                m.d.sync += address.eq(0)
        with m.If(self.flush):
            m.d.sync += [self.valid.eq(0), waiting.eq(0)]
        return m
