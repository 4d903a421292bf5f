"""Tags that travel beside a pipeline."""

from amaranth.hdl import Module, Signal


class DelayLines:
    """Values some cycles later, each delay line shared by its readers."""

    def __init__(self, m: Module):
        self._m, self._lines = m, {}

    def later(self, value: Signal, cycles: int) -> Signal:
        """``value``, a signal with a name, ``cycles`` cycles later."""
        line = self._lines.setdefault(value.name, [value])
        while len(line) <= cycles:
            register = Signal.like(value, name=f"{value.name}_d{len(line)}")
            self._m.d.sync += register.eq(line[-1])
            line.append(register)
        return line[cycles]
