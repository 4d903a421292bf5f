"""The way from the link's components to the host port of the circuit."""

from amaranth.hdl import Cat, Module, Mux, Signal, Value
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.registers import LINK
from hw.machine.host_port import LATENCY as HOST_LATENCY
from hw.machine.interfaces import HostAccess, HostBus
from hw.map.control import Control
from hw.map.memory_map import ADDRESS, Region, join

LATENCY = 1 + HOST_LATENCY + 1
"""Cycles from a request to its answer: the core may be placed far away, so there is a register each way."""


class PortSwitch(wiring.Component):
    """Join the components that use the host port. They use it one at a time, and wait for each answer.

    Parameters
    ----------
    state : int
        Bits of a word.

    Members
    -------
    walker, pause : In(HostAccess)
        Requests; an answer goes to both.
    ask_faults : In(1)
        Read the register of the faults; the answer comes at ``walker``.
    registers : Out(HostAccess)
        Requests of ``walker`` to the link's own registers.
    port : Out(HostBus)
        All other requests.
    """

    def __init__(self, state: int):
        access = {name: In(HostAccess(state)) for name in ("walker", "pause")}
        super().__init__(
            {**access, "ask_faults": In(1), "registers": Out(HostAccess(state)), "port": Out(HostBus(state))}
        )

    def elaborate(self, platform):
        m = Module()
        own = Signal()
        m.d.comb += [
            own.eq(ADDRESS.field("region", self.walker.address) == LINK),
            self.registers.request.eq(self.walker.request & own),
            _request(self.registers).eq(_request(self.walker)),
        ]
        m.d.sync += self.port.request.eq(self.pause.request | self.ask_faults | self.walker.request & ~own)
        with m.If(self.pause.request):
            m.d.sync += _request(self.port).eq(_request(self.pause))
        with m.Elif(self.ask_faults):
            m.d.sync += [self.port.write.eq(0), self.port.address.eq(join(Region.CONTROL, 0, Control.FAULTS, 0))]
        with m.Else():
            m.d.sync += _request(self.port).eq(_request(self.walker))
        answer = Signal(len(_answer(self.port)))
        m.d.sync += answer.eq(Mux(self.registers.answer, _answer(self.registers), _answer(self.port)))
        m.d.comb += [_answer(self.walker).eq(answer), _answer(self.pause).eq(answer)]
        return m


def _request(port) -> Value:
    return Cat(port.write, port.address, port.write_data)


def _answer(port) -> Value:
    return Cat(port.answer, port.error, port.read_data)
