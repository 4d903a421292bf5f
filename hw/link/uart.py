"""The serial line: eight data bits, no parity, one stop bit."""

from amaranth.hdl import Cat, Module, Signal
from amaranth.lib import wiring
from amaranth.lib.cdc import FFSynchronizer
from amaranth.lib.wiring import In, Out

from hw.link.interfaces import ByteStream, ReceivedBytes

BAUD_LEAST, BAUD_MOST = 115_200, 3_000_000
LEAST_CYCLES = 8
"""Fewest cycles of a bit: its three samples are taken near its middle."""
MOST_ERROR = 0.015
"""Largest relative error of the achieved rate. A receiver tolerates 2 %."""


def cycles_per_bit(clock_hz: float, baud: int) -> int:
    """Return the clock cycles of a bit.

    Raises
    ------
    ValueError
        If the rate is out of range, too fast for the clock, or missed by more than `MOST_ERROR`.
    """
    if not BAUD_LEAST <= baud <= BAUD_MOST:
        raise ValueError(f"baud must be {BAUD_LEAST} to {BAUD_MOST}, not {baud}")
    cycles = round(clock_hz / baud)
    if cycles < LEAST_CYCLES:
        raise ValueError(
            f"baud must be at most {clock_hz / LEAST_CYCLES:.0f} with a clock of {clock_hz / 1e6:g} MHz, not {baud}"
        )
    if abs(error := achieved(clock_hz, cycles) / baud - 1) > MOST_ERROR:
        raise ValueError(
            f"baud must be a rate that a clock of {clock_hz / 1e6:g} MHz meets within {MOST_ERROR:.1%}, "
            f"not {baud}: {cycles} cycles a bit are {error:+.1%} off"
        )
    return cycles


def achieved(clock_hz: float, cycles: int) -> float:
    """Return the achieved rate in bits a second."""
    return clock_hz / cycles


class Receiver(wiring.Component):
    """Receive bytes from the line. A bit is the majority of three samples around its middle; a start bit that reads as
    1 is noise, and ignored.

    Parameters
    ----------
    cycles : int
        Cycles of a bit, at least `LEAST_CYCLES`.

    Members
    -------
    rx : In(1)
        The line, 1 when idle; asynchronous.
    received : Out(ReceivedBytes)
        After an error the next start bit is awaited only when the line has been idle again.
    """

    def __init__(self, cycles: int):
        if cycles < LEAST_CYCLES:
            raise ValueError(f"cycles must be at least {LEAST_CYCLES}, not {cycles!r}")
        self._cycles = cycles
        super().__init__({"rx": In(1), "received": Out(ReceivedBytes())})

    def elaborate(self, platform):
        m = Module()
        line = Signal(init=1)
        m.submodules += FFSynchronizer(self.rx, line, init=1)
        middle, apart = self._cycles // 2, max(1, self._cycles // 8)
        votes = middle - apart, middle, middle + apart
        cycle = Signal(range(self._cycles))
        samples = Signal(2)
        bits = Signal(range(10))
        majority = (samples & line.replicate(2)).any() | samples.all()
        m.d.sync += [self.received.valid.eq(0), self.received.error.eq(0), cycle.eq(cycle + 1)]
        with m.If(cycle == self._cycles - 1):
            m.d.sync += cycle.eq(0)
        with m.If(Cat(cycle == vote for vote in votes[:2]).any()):
            m.d.sync += samples.eq(Cat(line, samples[0]))
        with m.FSM():
            with m.State("idle"):
                m.d.sync += [cycle.eq(1), bits.eq(0)]  # in cycle 0 of the start bit the line has just fallen
                with m.If(~line):
                    m.next = "bits"
            with m.State("bits"):
                with m.If(cycle == votes[2]):
                    m.d.sync += bits.eq(bits + 1)
                    with m.If((bits == 0) & majority):
                        m.next = "idle"
                    with m.Elif(bits == 9):
                        m.d.sync += [self.received.valid.eq(majority), self.received.error.eq(~majority)]
                        m.d.sync += self.received.broken.eq(~majority & ~self.received.data.any())
                        with m.If(majority):
                            m.next = "idle"
                        with m.Else():
                            m.next = "wait"
                    with m.Elif(bits != 0):
                        m.d.sync += self.received.data.eq(Cat(self.received.data[1:], majority))
            with m.State("wait"):
                with m.If(line):
                    m.next = "idle"
        return m


class Transmitter(wiring.Component):
    """Send bytes over the line.

    Members
    -------
    bytes : In(ByteStream)
        A byte that is taken is on the line for 10 times ``cycles``.
    tx : Out(1)
    """

    def __init__(self, cycles: int):
        self._cycles = cycles
        super().__init__({"bytes": In(ByteStream()), "tx": Out(1, init=1)})

    def elaborate(self, platform):
        m = Module()
        # a 1 after the stop bit marks the end
        rest = Signal(9)
        cycle = Signal(range(self._cycles))
        busy = Signal()
        m.d.comb += self.bytes.ready.eq(~busy)
        with m.If(self.bytes.valid & self.bytes.ready):
            m.d.sync += [busy.eq(1), rest.eq(Cat(self.bytes.data, 1)), self.tx.eq(0), cycle.eq(0)]
        with m.If(busy):
            m.d.sync += cycle.eq(cycle + 1)
            with m.If(cycle == self._cycles - 1):
                m.d.sync += [cycle.eq(0), self.tx.eq(rest[0]), rest.eq(rest >> 1)]
                with m.If(~rest.any()):
                    m.d.sync += [busy.eq(0), self.tx.eq(1)]
        return m
