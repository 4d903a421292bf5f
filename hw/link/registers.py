"""The link's own registers: what became of the bytes that came, and how long the host may be silent."""

from enum import IntEnum

from amaranth.hdl import Array, Module, Mux, Signal
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.link.interfaces import EVENTS, FrameEvents
from hw.machine.interfaces import named
from hw.map.memory_map import ADDRESS, Region

LINK = len(Region)
"""Number of their region, behind those of the circuit."""

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
    Link.HALTS: "runs that ended so",
    Link.GOOD_FRAMES: "frames that were all right",
    Link.LINE_ERRORS: "frames dropped: a byte had no stop bit, or a break came",
    Link.BREAKS: "breaks",
    Link.COBS_ERRORS: "frames dropped: not COBS",
    Link.LENGTH_ERRORS: "frames dropped: not as long as they said",
    Link.CRC_ERRORS: "frames dropped: wrong CRC",
    Link.OVERRUNS: "frames dropped: no room",
    Link.DUPLICATES: "commands that had been done before, and were answered again",
    Link.GAPS: "commands dropped, because one before them is missing or there is no session",
}

COUNTERS = tuple(register for register in Link if register != Link.WATCHDOG)
assert [counter.name.lower() for counter in COUNTERS[1:-2]] == list(EVENTS)


class LinkRegisters(wiring.Component):
    """Answers a request two cycles later. Counters go round at 2^32 and are cleared by any write.

    Parameters
    ----------
    state : int
        Bits of a word.

    Members
    -------
    request, write : In(1), index : In, data : In
    answer, error : Out(1), read_data : Out
        An error is no such register, or more than `BITS` bits for it: nothing is changed.
    frames : In(FrameEvents), duplicates : In(1), gaps : In(1)
        What is counted happens in this cycle.
    halted : In(1)
        The run was ended.
    busy : In(1)
    halt : Out(1)
        A run goes on, and the host has been silent for too long.
    """

    def __init__(self, state: int):
        super().__init__(
            {
                "request": In(1),
                "write": In(1),
                "index": In(ADDRESS["index"].width),
                "data": In(state),
                "answer": Out(1),
                "error": Out(1),
                "read_data": Out(state),
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
        lawful = (self.index < len(Link)) & ~(self.write & self.data[BITS:].any())
        registers = [Signal(BITS, name=register.name.lower()) for register in Link]
        request = Signal()
        error = Signal()
        index = Signal(range(len(Link)))
        data = Signal(BITS)
        writes = Signal(len(Link))
        m.d.sync += [
            request.eq(self.request),
            error.eq(self.request & ~lawful),
            index.eq(self.index),
            data.eq(self.data),
            *(writes[register].eq(self.request & self.write & lawful & (self.index == register)) for register in Link),
            self.answer.eq(request),
            self.error.eq(error),
            self.read_data.eq(Mux(error, 0, Array(registers)[index])),
        ]
        most = registers[Link.WATCHDOG]
        with m.If(writes[Link.WATCHDOG]):
            m.d.sync += most.eq(data)
        happens = {"halts": self.halted, "duplicates": self.duplicates, "gaps": self.gaps, **named(self.frames)}
        for counter in COUNTERS:
            count = registers[counter]
            m.d.sync += count.eq(Mux(writes[counter], 0, count + happens[counter.name.lower()]))
        silence = Signal(BITS)
        over = Signal()
        ended = Signal()
        m.d.sync += [silence.eq(silence + 1), over.eq((silence >= most) & (most != 0))]
        with m.If(self.frames.good_frames | writes[Link.WATCHDOG] | ~self.busy):
            m.d.sync += [silence.eq(0), over.eq(0)]
        with m.If(self.halted | ~self.busy):  # once a run: it takes until its step is over
            m.d.sync += ended.eq(self.busy)
        m.d.comb += self.halt.eq(over & self.busy & ~ended)
        return m
