"""Memories that the host reads and writes while the machine is idle, and the machine while it runs."""

from dataclasses import dataclass

from amaranth.hdl import Module, Mux, Signal, Value

from hw.machine.routes import PORT


@dataclass(frozen=True)
class Use:
    """The values that one side puts on a memory's ports; None for a port that it leaves alone."""

    address: Value | None = None
    write: Value | None = None
    write_address: Value | None = None
    write_data: Value | None = None


def registered_ports(m: Module, ram, name: str, host: Value, by_host: Use, own: Use):
    """Drive a memory's ports from registers: from the host while ``host`` is 1, else from the machine.

    A port that only one side uses is always that side's; one that neither uses is left alone. There are
    `hw.machine.routes.PORT` registers at each.

    Raises
    ------
    ValueError
        If there are none.
    """
    if PORT < 1:
        raise ValueError(f"PORT must be at least 1 register, not {PORT}")
    for port, label, theirs, ours in (
        (ram.address, "address", by_host.address, own.address),
        (ram.write, "write", by_host.write, own.write),
        (ram.write_address, "write_address", by_host.write_address, own.write_address),
        (ram.write_data, "write_data", by_host.write_data, own.write_data),
    ):
        if theirs is None and ours is None:
            continue
        value = ours if theirs is None else theirs if ours is None else Mux(host, theirs, ours)
        for number in reversed(range(PORT)):
            suffix = f"_{number}" if number else ""
            register = Signal.like(port, name=f"{name}_{label}_register{suffix}", reset_less=label != "write")
            m.d.sync += register.eq(value)
            value = register
        m.d.comb += port.eq(value)
