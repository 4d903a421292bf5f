"""Delay lines: a value some cycles later, in registers or in a small memory."""

from amaranth.hdl import Const, Module, Mux, Signal, Value
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

SHORTEST_RING, LONGEST_RING = 5, 17
"""Cycles for which a ring is smaller than registers: its words fit a memory of lookup tables, 16 deep."""


class Ring(wiring.Component):
    """A value ``cycles`` later, from a small memory used as a ring buffer.

    Members
    -------
    i : In, o : Out

    Raises
    ------
    ValueError
        If there are fewer than 3 or more than `LONGEST_RING` cycles.
    """

    def __init__(self, *, width: int, cycles: int):
        if not 3 <= cycles <= LONGEST_RING:
            raise ValueError(f"cycles must be 3 to {LONGEST_RING}, not {cycles!r}")
        self._cycles = cycles
        self.kind = f"delay_{cycles}x{width}"
        super().__init__({"i": In(width), "o": Out(width)})

    def elaborate(self, platform):
        m = Module()
        depth = self._cycles - 1  # and the register after it
        m.submodules.words = words = memory.Memory(shape=len(self.i), depth=depth, init=())
        write = words.write_port()
        read = words.read_port(domain="comb")
        index = Signal(range(depth), reset_less=True)
        word = Signal(len(self.i), reset_less=True)
        m.d.sync += [index.eq(index + 1), word.eq(read.data)]
        with m.If(index == depth - 1):
            m.d.sync += index.eq(0)
        m.d.comb += [
            write.en.eq(1),
            write.addr.eq(index),
            write.data.eq(self.i),
            read.addr.eq(index),
            self.o.eq(word),
        ]
        return m


class DelayLines:
    """Delay lines in a module, each shared by all its readers; `build` makes them once all have asked.

    ``reset`` clears the values that are 0 after a reset, in a module with a reset of its own; otherwise the reset of
    the clock domain does.
    """

    def __init__(self, m: Module, reset: Value | None = None):
        self._m, self._reset, self._lines = m, reset, {}

    def later(self, value: Value, cycles: int, *, name: str = "", reset: bool = False, wire: bool = False) -> Value:
        """Return ``value`` so many cycles later.

        Parameters
        ----------
        name : str
            The registers' name begins with it; by default with the signal's own.
        reset : bool
            Whether the value is 0 after a reset. Data that only matter with a valid bit need no reset.
        wire : bool
            Whether the value comes from logic instead of a register. A register then comes before any ring, because
            memories sit at fixed sites.

        Raises
        ------
        ValueError
            If ``cycles`` is negative.
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
        """Make the registers, and rings between taps that are far apart."""
        for (_, reset), (value, taps) in self._lines.items():
            reached, last = 0, value
            for cycles, tap in sorted(taps.items()):
                self._extend(tap, last, reached, cycles, reset)
                reached, last = cycles, tap

    def _extend(self, tap, value, reached, cycles, reset):
        name = tap.name.rpartition("_d")[0]
        while reached < cycles:
            left = cycles - reached
            stride = min(left, LONGEST_RING) if left >= SHORTEST_RING and not reset else 1
            reached += stride
            stop = tap if reached == cycles else Signal.like(tap, name=f"{name}_d{reached}")
            if stride == 1:
                self._m.d.sync += stop.eq(Mux(self._reset, 0, value) if reset and self._reset is not None else value)
            else:
                self._m.submodules[f"{name}_ring{reached}"] = ring = Ring(width=len(tap), cycles=stride)
                self._m.d.comb += [ring.i.eq(value), stop.eq(ring.o)]
            value = stop
