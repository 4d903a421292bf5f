"""A line to a circuit: bytes both ways, over any port that pyserial can open."""

from __future__ import annotations

from typing import Protocol

import serial

from sim.backends.link.errors import LineBroken


class Line(Protocol):
    """Bytes to and from a circuit: `SerialLine`, or a simulated one.

    Attributes
    ----------
    url : str
        Its name, for messages.
    """

    url: str

    def write(self, data: bytes) -> None:
        """Send bytes. Raises `LineBroken` if the line is gone."""

    def read(self, seconds: float) -> bytes:
        """Return the bytes that came; wait at most ``seconds`` for the first. Raises `LineBroken`."""

    def close(self) -> None:
        """Close the line."""


class SerialLine:
    """A port of this machine, or a socket.

    Parameters
    ----------
    url : str
        A device's name, or a URL that pyserial knows, such as ``socket://127.0.0.1:5000``.
    baud : int
        Bits a second; a socket ignores it.

    Raises
    ------
    LineBroken
        If the port can't be opened. Also raised by `write` and `read` once it has disappeared.
    """

    def __init__(self, url: str, baud: int):
        self.url = url
        try:
            self._port = serial.serial_for_url(url, baudrate=baud, timeout=0, write_timeout=5)
        except (serial.SerialException, ValueError, OSError) as error:
            raise LineBroken(
                f"--port must be a port that can be opened, not {url}: {_reason(error)} "
                "(make doctor lists the ports of this machine)"
            ) from None

    def write(self, data: bytes) -> None:
        """Send bytes."""
        self._checked(self._port.write, data)

    def read(self, seconds: float) -> bytes:
        """Return the bytes that have come; wait for the first one for at most ``seconds``."""
        self._port.timeout = seconds
        first = self._checked(self._port.read, 1)
        if not first:
            return b""
        self._port.timeout = 0
        return first + self._checked(self._port.read, 4096)

    def close(self) -> None:
        """Close the port."""
        socket = getattr(self._port, "_socket", None)
        self._port.close()
        if socket:
            socket.close()  # pyserial leaves it open if the other side is gone

    def _checked(self, call, argument):
        try:
            return call(argument)
        except (serial.SerialException, OSError) as error:
            raise LineBroken(f"--port must stay connected, but {self.url} is gone: {_reason(error)}") from None


def _reason(error) -> str:
    return str(getattr(error, "strerror", None) or error).strip().splitlines()[0]
