"""Serve a simulated circuit on a loopback socket, in place of a board on a serial port."""

from __future__ import annotations

import socket
from collections.abc import Callable

from golden.support.errors import InputError
from hw.link.bound import longest
from hw.link.items import LEAST, Items

HOST = "127.0.0.1"
SLICE = 2000
"""Cycles that are simulated between two reads of the socket."""
QUIET = 2 * longest(Items(LEAST))
"""Cycles without activity after which the simulation pauses until the host sends something: more than any command
takes."""


def listener(port: int) -> socket.socket:
    """Return a socket that listens on loopback; port 0 chooses a free one. Raises `InputError` if the port is taken."""
    server = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        server.bind((HOST, port))
    except OSError as error:
        server.close()
        raise InputError(f"--port must be a free port of this machine, not {port}: {error.strerror}") from None
    server.listen(1)
    return server


def serve(server: socket.socket, circuit, ends: Callable[[], bool] = lambda: False) -> None:
    """Connect one host after another to a `sim.backends.link.served.SerialCircuit`, which keeps its state between them.

    ``ends()`` is called after each slice, and every second while no host is connected. True ends the service.
    """
    server.settimeout(1.0)
    while not ends():
        try:
            client, _ = server.accept()
        except TimeoutError:
            continue
        with client:
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            _talk(client, circuit, ends)


def _talk(client, circuit, ends):
    quiet = 0
    while not ends():
        client.settimeout(1.0 if quiet >= QUIET else 0.0)
        try:
            data = client.recv(1 << 16)
            if not data:
                return
        except (BlockingIOError, TimeoutError):
            data = b""
        except OSError:
            return
        if not data and quiet >= QUIET:
            continue
        out = circuit.run(data, SLICE)
        quiet = quiet + SLICE if circuit.idle and not data and not out else 0
        if out:
            try:
                client.settimeout(None)
                client.sendall(out)
            except OSError:
                return
