"""Delay lines: a value some cycles later."""

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

RING_LEAST, RING_MOST = 5, 17
"""Cycles for which a ring is smaller than registers; a ring's words fill a memory of lookup tables, 16 deep."""


class Ring(wiring.Component):
    """A value ``cycles`` later, kept in a small memory that is written round and round.

    Members
    -------
    i : In, o : Out

    Raises
    ------
    ValueError
        If there are fewer than 3 or more than `RING_MOST` cycles.
    """

    def __init__(self, *, width: int, cycles: int):
        if not 3 <= cycles <= RING_MOST:
            raise ValueError(f"cycles must be 3 to {RING_MOST}, not {cycles!r}")
        self._cycles = cycles
        self.kind = f"delay_{cycles}x{width}"
        super().__init__({"i": In(width), "o": Out(width)})

    def elaborate(self, platform):
        m = Module()
        depth = self._cycles - 1  # and the register behind it
        m.submodules.words = words = memory.Memory(shape=len(self.i), depth=depth, init=())
        write = words.write_port()
        read = words.read_port(domain="comb")
        place = Signal(range(depth), reset_less=True)
        word = Signal(len(self.i), reset_less=True)
        m.d.sync += [place.eq(place + 1), word.eq(read.data)]
        with m.If(place == depth - 1):
            m.d.sync += place.eq(0)
        m.d.comb += [
            write.en.eq(1),
            write.addr.eq(place),
            write.data.eq(self.i),
            read.addr.eq(place),
            self.o.eq(word),
        ]
        return m


class DelayLines:
    """Delay lines in a module, each shared by all who read it; `build` makes them, when all have asked.

    ``reset`` clears what is to be 0 after a reset, in a module that has a reset of its own; otherwise the clock
    domain's does.
    """

    def __init__(self, m: Module, reset: Value | None = None):
        self._m, self._reset, self._lines = m, reset, {}

    def later(self, value: Value, cycles: int, *, name: str = "", reset: bool = False, wire: bool = False) -> Value:
        """``value`` so many cycles later.

        Parameters
        ----------
        name : str
            What the registers are called after; a signal's own name if not given.
        reset : bool
            Whether the value is 0 after a reset. What only matters beside something valid needs none.
        wire : bool
            Whether the value comes from logic, not from a register: then a register takes it before any ring does, for
            the way to a memory is long.

        Raises
        ------
        ValueError
            If the value is to be had before it comes.
        """
        if cycles < 0:
            raise ValueError(f"a value must be delayed by at least 0 cycles, not {cycles}")
        if not cycles or isinstance(value, Const):
            return value
        name = name or value.name
        _, taps = self._lines.setdefault((id(value), reset), (value, {}))
        if wire and cycles > 1:
            self.later(value, 1, name=name, reset=reset)
        if cycles not in taps:
            taps[cycles] = Signal(
                value.shape(), name=f"{name}_d{cycles}", reset_less=not reset or self._reset is not None
            )
        return taps[cycles]

    def build(self):
        """Registers, and rings between taps that are far apart."""
        for (_, reset), (value, taps) in self._lines.items():
            past, last = 0, value
            for cycles, tap in sorted(taps.items()):
                self._reach(tap, last, past, cycles, reset)
                past, last = cycles, tap

    def _reach(self, tap, value, past, cycles, reset):
        name = tap.name.rpartition("_d")[0]
        while past < cycles:
            left = cycles - past
            stride = min(left, RING_MOST) if left >= RING_LEAST and not reset else 1
            past += stride
            stop = tap if past == cycles else Signal.like(tap, name=f"{name}_d{past}")
            if stride == 1:
                self._m.d.sync += stop.eq(Mux(self._reset, 0, value) if reset and self._reset is not None else value)
            else:
                self._m.submodules[f"{name}_ring{past}"] = ring = Ring(width=len(tap), cycles=stride)
                self._m.d.comb += [ring.i.eq(value), stop.eq(ring.o)]
            value = stop
