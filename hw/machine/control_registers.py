"""The control registers: what may be written to them, what a write does, and what a read returns."""

from amaranth.hdl import Cat, Const, Module, Mux, Signal, Value

from hw.machine.interfaces import named
from hw.map.control import COUNTERS, REGISTERS, Control, constants
from hw.parameters import Parameters

WRITABLE = [register for register, row in REGISTERS.items() if row.writable]

ANYTIME = [register for register, row in REGISTERS.items() if row.while_busy]
"""Control registers that may be written while the machine is busy."""

COUNTS = [register for register, row in REGISTERS.items() if row.least == 1]
"""Control registers to which 0 may not be written."""


def in_range(p: Parameters, data: Value) -> Value:
    """Return a bit for each control register: 1 if the data are small enough to be written to it."""
    return Cat(data <= row.most(p) if row.most else Const(row.writable) for row in REGISTERS.values())


def reads(m: Module, port, p: Parameters, written: dict[Control, Value], refuse: Value) -> list[Value]:
    """Add the registers of a host port to its module. Return the value that a read of each returns, in the order of
    `Control`.

    Parameters
    ----------
    port : hw.machine.host_port.HostPort
        Its ports ``rows``, ``nodes``, ``velocity_shift`` and ``steps`` are registers.
    written : dict of Control to Value
        1 if ``port.memories.data`` is written to the register in this cycle.
    refuse : Value
        1 if a request was refused.
    """
    data, state = port.memories.data, p.formats.state
    refused = Signal(32)
    faults = Signal(len(port.fault), name="sticky_faults")
    m.d.sync += refused.eq(refused + refuse)
    for register, target in (
        (Control.ROW_COUNT, port.rows),
        (Control.NODE_COUNT, port.nodes),
        (Control.VELOCITY_SHIFT, port.velocity_shift),
        (Control.RUN, port.steps),
    ):
        with m.If(written[register]):
            m.d.sync += target.eq(data)
    with m.If(written[Control.REFUSED]):
        m.d.sync += refused.eq(0)
    clear = Mux(written[Control.FAULTS], data[: len(faults)], 0)
    m.d.sync += faults.eq(faults & ~clear | port.fault)
    counters = named(port.counters)
    values = {
        **{register: Const(value, state) for register, value in constants(p).items()},
        Control.BUSY: port.busy | port.start,
        **{register: counters[name] for register, name in COUNTERS.items()},
        Control.STEPS_DONE: port.steps_done,
        Control.FAULTS: faults,
        Control.REFUSED: refused,
        Control.ROW_COUNT: port.rows,
        Control.NODE_COUNT: port.nodes,
        Control.VELOCITY_SHIFT: port.velocity_shift,
        Control.RUN: Const(0, state),
        Control.STOP: Const(0, state),
    }
    return [values[register] for register in Control]
