"""Memories: a block RAM with its output register, and a small one of lookup tables."""

from amaranth.hdl import Module, Signal
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import In, Out

READ_LATENCY = 2
"""Cycles from a block RAM's address to its data: its own read, then its output register, which is part of the block.
Block RAMs and DSPs sit at fixed sites, so one more register on the route to or from them helps timing."""


class _Ram(wiring.Component):
    def __init__(self, kind: str, width: int, depth: int):
        if depth < 1:
            raise ValueError(f"depth must be at least 1, not {depth!r}")
        if width < 1:
            raise ValueError(f"width must be at least 1, not {width!r}")
        self.depth, self.kind = depth, f"{kind}_{depth}x{width}"
        bits = max(1, (depth - 1).bit_length())
        super().__init__(
            {
                "write": In(1),
                "write_address": In(bits),
                "write_data": In(width),
                "address": In(bits),
                "data": Out(width),
            }
        )

    def _elaborate(self, domain: str, registers: int, init=()) -> Module:
        """Return a module with the memory and registers after it."""
        m = Module()
        m.submodules.words = words = memory.Memory(shape=len(self.data), depth=max(2, self.depth), init=init)
        write = words.write_port()
        read = words.read_port(domain=domain)
        word = read.data
        for number in range(registers):
            register = Signal(len(self.data), name=f"word_{number}" if number else "word", reset_less=True)
            m.d.sync += register.eq(word)
            word = register
        m.d.comb += [
            write.en.eq(self.write),
            write.addr.eq(self.write_address),
            write.data.eq(self.write_data),
            read.addr.eq(self.address),
            self.data.eq(word),
        ]
        return m


class BlockRam(_Ram):
    """A memory with one write and one read port in block RAM.

    A word appears `READ_LATENCY` cycles after its address, one a cycle. A word that is read in the cycle in which it
    is written is undefined on real devices (here it is the old one); a later read finds it.

    ``init`` are its contents at power-on, 0 by default. A family makes its own module of it, if it has block RAMs
    (``get_block_ram`` of Amaranth's ``platform``).

    Members
    -------
    write : In(1), write_address : In, write_data : In
    address : In, data : Out

    Raises
    ------
    ValueError
        If the memory has no words or no bits, or a family's block RAM has another latency than `READ_LATENCY`.
    """

    def __init__(self, *, width: int, depth: int, init=()):
        self.init = init
        super().__init__("rom" if init else "block_ram", width, depth)

    def elaborate(self, platform):
        block = platform.get_block_ram(self) if hasattr(platform, "get_block_ram") else None
        if block and READ_LATENCY != 2:
            raise ValueError(f"the read latency of a family's block RAM must be 2 cycles, not {READ_LATENCY}")
        return block or self._elaborate("sync", READ_LATENCY - 1, self.init)


class LutRam(_Ram):
    """A small memory of lookup tables, with the members and errors of a `BlockRam`. A word appears in the cycle after
    its address."""

    def __init__(self, *, width: int, depth: int):
        super().__init__("lut_ram", width, depth)

    def elaborate(self, platform):
        return self._elaborate("comb", 1)
