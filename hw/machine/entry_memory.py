"""The memory of a list: entries for its `hw.machine.fetch`, or for the host while nothing runs."""

from amaranth.hdl import Module, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.machine.host_port import registered_ports

LATENCY = 1 + READ_LATENCY + 1
"""Cycles from a list's address to its entry: a register before the memory, whose place is given, another behind it."""


class EntryMemory(wiring.Component):
    """A memory with registers of its own at all of its ports, wherever those are that read and write it.

    Throughput: an entry a cycle, `LATENCY` cycles behind its address.

    Parameters
    ----------
    width, depth : int

    Members
    -------
    host : In(1)
        The host reads; if not, the fetch.
    host_address, fetch_address : In
    write : In(1), write_address, write_data : In
        Only while nothing runs.
    data : Out, entry : Out
        The word, and the same a cycle later, from a register.
    """

    def __init__(self, *, width: int, depth: int):
        self._ram = ram = BlockRam(width=width, depth=depth)
        self.kind = f"entry_memory_{depth}x{width}"
        bits = len(ram.address)
        super().__init__(
            {
                "host": In(1),
                "host_address": In(bits),
                "fetch_address": In(bits),
                "write": In(1),
                "write_address": In(bits),
                "write_data": In(width),
                "data": Out(width),
                "entry": Out(width),
            }
        )

    def elaborate(self, platform):
        m = Module()
        m.submodules.ram = ram = self._ram
        by_host = {port: getattr(self, port) for port in ("write", "write_address", "write_data")}
        registered_ports(
            m, ram, "ram", self.host, {"address": self.host_address, **by_host}, {"address": self.fetch_address}
        )
        entry = Signal(len(self.entry), reset_less=True)
        m.d.sync += entry.eq(ram.data)
        m.d.comb += [self.data.eq(ram.data), self.entry.eq(entry)]
        return m
