"""A small circuit with its link, simulated by Verilator: bytes in, bytes out."""

import ctypes
import functools
from pathlib import Path

from amaranth.hdl import Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out
from link_objects import KEY

from hw.emit.verilog import convert
from hw.link.device import Device
from hw.link.frame import Frame, unpacked
from hw.link.items import Items
from hw.link.receive import BYTE_CYCLES
from hw.machine.core import Core
from hw.map.control import MAGIC
from hw.parameters import Parameters
from sim.backends.rtl import BUILD
from sim.backends.verilated import library, opened

SHIM = Path(__file__).with_name("linked.cpp")
SMALL = Parameters(lanes=1, nodes=16, edges=16, materials=2, tables=1)
ITEMS = Items.of_word(SMALL.formats.state)
IDENTITY = [MAGIC, 0x123456789]
ROOM = 100_000
QUIET = 5000
"""Cycles after which no more bytes come, more than a command of these tests and the CRC of its answer take."""


class Linked(wiring.Component):
    def __init__(self):
        super().__init__({"valid": In(1), "data": In(8), "out_valid": Out(1), "out_data": Out(8)})

    def elaborate(self, platform):
        m = Module()
        m.submodules.core = core = Core(SMALL)
        m.submodules.device = device = Device(key=KEY, identity=IDENTITY, state=SMALL.formats.state)
        wiring.connect(m, device.port, core)
        m.d.comb += [
            device.received.valid.eq(self.valid),
            device.received.data.eq(self.data),
            self.out_valid.eq(device.sent.valid),
            self.out_data.eq(device.sent.data),
            device.sent.ready.eq(1),
        ]
        return m


@functools.cache
def verilog() -> str:
    return convert(Linked(), "linked")


class Line:
    """The simulated circuit, as a host sees it."""

    def __init__(self):
        shared = opened(library("linked", verilog(), SHIM, folder=BUILD))
        self._run, self._delete = shared.linked_run, shared.linked_delete
        shared.linked_new.restype = ctypes.c_void_p
        self._run.restype = ctypes.c_long
        number, pointer = ctypes.c_long, ctypes.c_char_p
        self._run.argtypes = [ctypes.c_void_p, pointer, number, number, number, pointer, number]
        self._delete.argtypes = [ctypes.c_void_p]
        self._handle = shared.linked_new()

    def close(self):
        self._delete(self._handle)

    def send(self, line: bytes, cycles: int) -> bytes:
        """Return the bytes that come out while these go in, and for so many cycles after."""
        out = ctypes.create_string_buffer(ROOM)
        came = self._run(self._handle, line, len(line), BYTE_CYCLES, cycles, out, ROOM)
        assert came <= ROOM
        return out.raw[:came]

    def exchange(self, *commands: Frame) -> list[Frame]:
        """Return the answers to commands; each is sent when the answer before it has ended."""
        out = b""
        for command in commands:
            out += self.send(command.packed(KEY), QUIET)
            while more := self.send(b"", QUIET):
                out += more
        return [unpacked(coded, KEY) for coded in out.split(b"\0") if coded]
