"""Delay lines: a value some cycles later."""

from amaranth.hdl import Module, Signal, Value


class DelayLines:
    """Delay lines in a module, each shared by all who read it."""

    def __init__(self, m: Module):
        self._m, self._lines = m, {}

    def later(self, value: Value, cycles: int, *, name: str = "", reset: bool = False) -> Value:
        """``value`` so many cycles later.

        Parameters
        ----------
        name : str
            What the registers are called after; a signal's own name if not given.
        reset : bool
            Whether the registers are 0 after a reset. What only matters beside something valid needs none.
        """
        line = self._lines.setdefault(id(value), [value])
        while len(line) <= cycles:
            register = Signal(value.shape(), name=f"{name or value.name}_d{len(line)}", reset_less=not reset)
            self._m.d.sync += register.eq(line[-1])
            line.append(register)
        return line[cycles]
