"""A session with a circuit: each command is done exactly once and in order, whatever the line loses."""

from __future__ import annotations

import secrets
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from time import monotonic

from hw.link.frame import ANSWER, KEY_BYTES, Frame, FrameError, unpacked
from hw.link.identity import Identity
from hw.link.items import LEAST, Items
from hw.link.protocol import GREETING_BYTES, WINDOW, Operation, Status
from sim.backends.link.errors import NoAnswer, OtherCircuit
from sim.backends.link.line import Line

TIMEOUT = 2.0
"""Seconds without a good answer after which the commands under way are sent again."""
ATTEMPTS = 6
NO_KEY = bytes(KEY_BYTES)
Command = tuple[Operation, bytes]


class Session:
    """Send commands by go-back-N, with a window of `hw.link.protocol.WINDOW`.

    Parameters
    ----------
    line : Line
    key_of : callable
        Returns the key for an identity, or raises `OtherCircuit`.
    timeout : float
        Seconds until the commands under way are sent again.
    attempts : int
    clock : callable
        Returns seconds; a simulated line has its own time.

    Attributes
    ----------
    identity : Identity
    items : Items
        The form of the circuit's items.
    retries : int
        Number of times that the commands under way were sent again.
    damaged : int
        Number of damaged frames that came.

    Raises
    ------
    NoAnswer
        If no answer came to ``attempts`` transmissions in a row; also raised by `commands`.
    OtherCircuit
        If the circuit has another version of the protocol.
    """

    def __init__(
        self,
        line: Line,
        key_of: Callable[[Identity], bytes],
        timeout: float = TIMEOUT,
        attempts: int = ATTEMPTS,
        clock: Callable[[], float] = monotonic,
    ):
        self._line, self._timeout, self._attempts, self._clock = line, timeout, attempts, clock
        self._key, self._buffer = NO_KEY, bytearray()
        self.retries = self.damaged = 0
        self.identity = self._greet()
        self._key = key_of(self.identity)

    def commands(self, wanted: Iterable[Command]) -> Iterator[Frame]:
        """Yield the answers in order as they come, while the next commands are under way."""
        wanted, under_way = iter(wanted), deque()
        more = True
        while more or under_way:
            fresh = []
            while more and len(under_way) + len(fresh) < WINDOW:
                command = next(wanted, None)
                more = command is not None
                if more:
                    fresh.append(self._frame(*command))
            under_way += fresh
            self._send(fresh)
            if under_way:
                yield self._answered(under_way)

    def _answered(self, under_way) -> Frame:
        """Return the answer to the first command under way."""
        for _ in range(self._attempts):
            until = self._clock() + self._timeout
            while (left := until - self._clock()) > 0:
                frame = self._frame_from_line(left)
                if frame and frame.seq == under_way[0].seq and frame.type == under_way[0].type | ANSWER:
                    under_way.popleft()
                    return frame
            self.retries += 1
            self._send(under_way)
        raise NoAnswer(
            f"--port must lead to a circuit that answers, but no answer came from {self._line.url} within "
            f"{self._attempts * self._timeout:.3g} s, and {self.damaged} damaged frames: check that the board is "
            "loaded (make flash), that --port is its serial port, and that --baud is the rate it was built for"
        )

    def _greet(self) -> Identity:
        """Begin a session; it ends an earlier one, and the zero byte ends an unfinished frame on the line."""
        nonce = secrets.randbits(8 * LEAST)
        self._seq = secrets.randbits(8)
        greeting = self._frame(Operation.HELLO, nonce.to_bytes(GREETING_BYTES, "little"))
        self._line.write(b"\0")
        self._send([greeting])
        under_way = deque([greeting])
        while True:
            answer = self._answered(under_way)
            try:
                self.items = Items(answer.item_bytes)
                items = self.items.split(answer.payload)
                if len(items) > 1 and items[1] == nonce and answer.status & 0xF == Status.DONE:
                    return Identity.read(items[2:])
            except ValueError as error:
                raise OtherCircuit(
                    f"--port must lead to a circuit of this version, but its identity has another form: {error}"
                ) from None
            under_way.append(greeting)  # it answered an earlier host's greeting

    def _frame(self, operation: Operation, payload: bytes) -> Frame:
        frame = Frame(operation, self._seq, payload=payload)
        self._seq = (self._seq + 1) % 256
        return frame

    def _send(self, frames) -> None:
        if frames:
            self._line.write(b"".join(frame.packed(self._key) for frame in frames))

    def _frame_from_line(self, seconds: float) -> Frame | None:
        """Return the next good frame, if one comes in time."""
        until = self._clock() + seconds
        while True:
            while (end := self._buffer.find(0)) >= 0:
                coded = bytes(self._buffer[:end])
                del self._buffer[: end + 1]
                if coded:
                    try:
                        return unpacked(coded, self._key)
                    except FrameError:
                        self.damaged += 1
            left = until - self._clock()
            if left <= 0:
                return None
            self._buffer += self._line.read(left)
