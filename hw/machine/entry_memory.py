"""The memory of a list."""

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.blocks.memory import READ_LATENCY, BlockRam
from hw.machine.interfaces import EntryAccess
from hw.machine.memory_ports import Use, registered_ports
from hw.machine.routes import PORT
from hw.pipeline.delay import DelayLines

REGISTERS = 1
"""Registers after the memory: block RAMs sit at fixed sites."""

LATENCY = PORT + READ_LATENCY + REGISTERS
"""Cycles from a list's address to its entry."""


class EntryMemory(wiring.Component):
    """A memory of a list's entries, read by its `hw.machine.fetch` or, while nothing runs, by the host.

    Throughput: an entry a cycle, `LATENCY` cycles after its address.

    Parameters
    ----------
    width, depth : int

    Members
    -------
    host : In(EntryAccess)
        It has the memory's read port while ``active``.
    address : In, entry : Out
    """

    def __init__(self, *, width: int, depth: int):
        self._ram = ram = BlockRam(width=width, depth=depth)
        self.kind = f"entry_memory_{depth}x{width}"
        bits = len(ram.address)
        super().__init__({"host": In(EntryAccess(bits, width)), "address": In(bits), "entry": Out(width)})

    def elaborate(self, platform):
        m, host = Module(), self.host
        lines = DelayLines(m)
        m.submodules.ram = ram = self._ram
        by_host = Use(address=host.index, write=host.write, write_address=host.index, write_data=host.data)
        registered_ports(m, ram, "ram", host.active, by_host, Use(address=self.address))
        m.d.comb += [host.word.eq(ram.data), self.entry.eq(lines.later(ram.data, REGISTERS, name="entry"))]
        lines.build()
        return m
