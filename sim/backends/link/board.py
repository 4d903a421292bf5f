"""A circuit that is reached over its link, used like `sim.backends.simulated_circuit.SimulatedCircuit`."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterable, Iterator
from time import monotonic, sleep

import numpy as np

from hw.link.description import key
from hw.link.identity import Identity
from hw.link.protocol import BUSY, STATUS_TEXT, Operation, Status
from hw.link.registers import LINK, Link
from hw.machine.core import datapaths, faults
from hw.map.control import MAGIC, Control
from hw.map.memory_map import Map, Region, join
from sim.backends.link import segments
from sim.backends.link.errors import CommandRefused, LinkError, OtherCircuit
from sim.backends.link.line import Line, SerialLine
from sim.backends.link.session import TIMEOUT, Session

BAUD = 1_000_000
POLL = 1e-3
"""Seconds between two requests that ask whether a run is over."""


class Board:
    """A circuit that is reached over a line.

    Parameters
    ----------
    line : Line
        See `at`.
    timeout : float
    clock : callable
        See `sim.backends.link.session.Session`.

    Attributes
    ----------
    parameters : Parameters
        The parameters in the circuit's identity.
    faults : list of str
        Names of the bits of its faults register.
    session : Session

    Raises
    ------
    LineBroken, NoAnswer, OtherCircuit
        See `sim.backends.link.errors`; the first two by every other method as well.
    """

    def __init__(self, line: Line, timeout: float = TIMEOUT, clock: Callable[[], float] = monotonic):
        self._line = line
        try:
            self.session = Session(line, lambda identity: _key(line.url, identity), timeout, clock=clock)
            self.parameters = self.session.identity.parameters()
            self.faults = faults(*datapaths(self.parameters))
            self.halt()
        except BaseException:
            self._line.close()
            raise

    @classmethod
    def at(cls, url: str, baud: int = BAUD, timeout: float = TIMEOUT) -> Board:
        """Return the circuit at a port that pyserial opens: ``/dev/ttyUSB0``, ``socket://127.0.0.1:5000``."""
        return cls(SerialLine(url, baud), timeout)

    def close(self):
        self._line.close()

    def write(self, writes: Iterable[tuple[int, int]]):
        """Write (address, data) pairs in this order.

        Raises
        ------
        CommandRefused
            If one is refused.
        ValueError
            If a word is longer than those of the circuit.
        """
        for _ in self._ask(segments.writes(self._checked(writes), self.session.items)):
            pass

    def read(self, addresses: list[int]) -> np.ndarray:
        """Return (n,) unsigned words. Raises `CommandRefused` if a read is refused."""
        words = [word for payload in self._ask(segments.reads(addresses, self.session.items)) for word in payload]
        return np.array(words, np.uint64)

    def verify(self, writes: Iterable[tuple[int, int]]):
        """Check by CRC that the circuit's memories hold what was written. Raises `LinkError` if they don't."""
        memory = Map(self.parameters)
        held = {address: data & memory.mask(address) for address, data in writes}
        wanted = iter(held.values())
        checks = list(segments.checks(list(held), self.session.items))
        answers = self._ask(payload for payload, _ in checks)
        for (_, counts), found in zip(checks, answers, strict=True):
            for count, crc in zip(counts, found, strict=True):
                if zlib.crc32(b"".join(self.session.items.pack(next(wanted)) for _ in range(count))) != crc:
                    raise LinkError("the circuit's memories must hold what was written, but their CRC differs")

    def run(self, cycles: int = 0) -> bool:
        """Return whether a run is under way. ``cycles`` is for simulated circuits; a real one has its own clock."""
        (answer,) = self.session.commands([(Operation.ACCESS, b"")])
        return bool(self._good(answer).status & BUSY)

    def wait(self):
        """Wait until the run is over."""
        while self.run():
            sleep(POLL)

    def halt(self):
        """End a run that an earlier host began, if there is one."""
        if self.run():
            self.write([(self._control(Control.STOP), 1)])
            self.wait()

    def exchange(self, payloads: Iterable[bytes]) -> Iterator[list[int]]:
        """Yield the words that each payload's segments read, each payload between two steps of a run."""
        return self._ask(payloads, Operation.EXCHANGE)

    def counters(self) -> dict[str, int]:
        """Return the link's registers by name."""
        words = self.read([join(LINK, 0, register, 0) for register in Link])
        return {register.name.lower(): int(word) for register, word in zip(Link, words, strict=True)}

    def watch(self, seconds: float):
        """Set the time without a good frame from the host after which a run is ended, in seconds; 0: never."""
        self.write([(join(LINK, 0, Link.WATCHDOG, 0), round(seconds * self.session.identity.clock_hz))])

    def _checked(self, writes) -> list[tuple[int, int]]:
        pairs, bits = list(writes), self.parameters.formats.state
        for _, word in pairs:
            if not 0 <= word < 1 << bits:
                raise ValueError(f"a word must have at most {bits} bits, not be {word:#x}")
        return pairs

    def _ask(self, payloads, operation=Operation.ACCESS):
        """Return each answer's items after the faults."""
        for answer in self.session.commands((operation, payload) for payload in payloads):
            yield self.session.items.split(self._good(answer).payload)[1:]

    def _good(self, answer):
        status = Status(answer.status & ~BUSY)
        if status == Status.STRANGER:
            raise LinkError("the circuit must not be reset while it is used, but it was: start again")
        if status != Status.DONE:
            raise CommandRefused(
                f"the circuit must accept each command, but answered {status.name}: {STATUS_TEXT[status]}"
            )
        return answer

    def _control(self, register):
        return join(Region.CONTROL, 0, register, 0)


def _key(url: str, identity: Identity) -> bytes:
    """Return the key of a circuit of this version. Raises `OtherCircuit` if it isn't."""
    try:
        if identity.magic != MAGIC:
            raise ValueError(f"magic must be {MAGIC:#x}, not {identity.magic:#x}")
        own = key(identity.parameters())
    except ValueError as error:
        raise OtherCircuit(f"--port must lead to a circuit of this version, not the one at {url}: {error}") from None
    if identity.key != own:
        raise OtherCircuit(
            f"--port must lead to a circuit with memory map {own.hex()}, as in this version, but the one at {url} has "
            f"{identity.key.hex()}: build and load the circuit again (make bitstream, make flash), or use the version "
            "that it was built with"
        )
    return own
