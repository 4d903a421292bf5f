"""The link's own registers: counters of frames and commands, and the watchdog."""

from enum import IntEnum

from amaranth.hdl import Array, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.interfaces import EVENTS, FrameEvents
from hw.machine.interfaces import HostAccess, named
from hw.map.memory_map import ADDRESS, Region

LINK = len(Region)
"""Number of their region, after those of the circuit."""

BITS = 32


class Link(IntEnum):
    """Index of a register."""

    WATCHDOG = 0
    HALTS = 1
    GOOD_FRAMES = 2
    LINE_ERRORS = 3
    BREAKS = 4
    COBS_ERRORS = 5
    LENGTH_ERRORS = 6
    CRC_ERRORS = 7
    OVERRUNS = 8
    DUPLICATES = 9
    GAPS = 10


LINK_TEXT = {
    Link.WATCHDOG: "clock cycles without a good frame after which a run ends with its step; 0: never",
    Link.HALTS: "runs that the watchdog ended",
    Link.GOOD_FRAMES: "frames without errors",
    Link.LINE_ERRORS: "frames dropped: a byte had no stop bit, or a break came",
    Link.BREAKS: "breaks",
    Link.COBS_ERRORS: "frames dropped: not COBS",
    Link.LENGTH_ERRORS: "frames dropped: not of the length in their header",
    Link.CRC_ERRORS: "frames dropped: wrong CRC",
    Link.OVERRUNS: "frames dropped: no room",
    Link.DUPLICATES: "commands that had been done before and were answered again",
    Link.GAPS: "commands dropped, because one before them is missing or there is no session",
}

COUNTERS = tuple(register for register in Link if register != Link.WATCHDOG)
assert [counter.name.lower() for counter in COUNTERS[1:-2]] == list(EVENTS)


class LinkRegisters(wiring.Component):
    """Answer each request two cycles later. Counters wrap at 2^32; any write clears them.

    Parameters
    ----------
    state : int
        Bits of a word.

    Members
    -------
    port : In(HostAccess)
        An error means that there is no such register, or that the word has more than `BITS` bits; nothing is changed.
    frames : In(FrameEvents), duplicates : In(1), gaps : In(1)
        Events to count.
    halted : In(1)
        The run was ended.
    busy : In(1)
    halt : Out(1)
        A run is under way, and the host has been silent for too long.
    """

    def __init__(self, state: int):
        super().__init__(
            {
                "port": In(HostAccess(state)),
                "frames": In(FrameEvents()),
                "duplicates": In(1),
                "gaps": In(1),
                "halted": In(1),
                "busy": In(1),
                "halt": Out(1),
            }
        )

    def elaborate(self, platform):
        m = Module()
        port, accessed = self.port, ADDRESS.field("index", self.port.address)
        value_ok = (accessed < len(Link)) & ~(port.write & port.write_data[BITS:].any())
        registers = [Signal(BITS, name=register.name.lower()) for register in Link]
        request = Signal()
        error = Signal()
        index = Signal(range(len(Link)))
        data = Signal(BITS)
        writes = Signal(len(Link))
        m.d.sync += [
            request.eq(port.request),
            error.eq(port.request & ~value_ok),
            index.eq(accessed),
            data.eq(port.write_data),
            *(writes[number].eq(port.request & port.write & value_ok & (accessed == number)) for number in Link),
            port.answer.eq(request),
            port.error.eq(error),
            port.read_data.eq(Mux(error, 0, Array(registers)[index])),
        ]
        most = registers[Link.WATCHDOG]
        with m.If(writes[Link.WATCHDOG]):
            m.d.sync += most.eq(data)
        events = {"halts": self.halted, "duplicates": self.duplicates, "gaps": self.gaps, **named(self.frames)}
        for counter in COUNTERS:
            count = registers[counter]
            m.d.sync += count.eq(Mux(writes[counter], 0, count + events[counter.name.lower()]))
        silence = Signal(BITS)
        over = Signal()
        ended = Signal()
        m.d.sync += [silence.eq(silence + 1), over.eq((silence >= most) & (most != 0))]
        with m.If(self.frames.good_frames | writes[Link.WATCHDOG] | ~self.busy):
            m.d.sync += [silence.eq(0), over.eq(0)]
        with m.If(self.halted | ~self.busy):  # only once: the run goes on until its step is over
            m.d.sync += ended.eq(self.busy)
        m.d.comb += self.halt.eq(over & self.busy & ~ended)
        return m
