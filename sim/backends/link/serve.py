"""A simulated circuit on a loopback socket, as a board would be on a serial port."""

from __future__ import annotations

import socket
from collections.abc import Callable

from golden.support.errors import InputError
from hw.link.bound import longest
from hw.link.items import LEAST, Items

HOST = "127.0.0.1"
SLICE = 2000
"""Cycles between two looks at the socket."""
QUIET = 2 * longest(Items(LEAST))
"""Cycles without anything on the line or going on after which time stands still until the host speaks: more than any
command takes."""


def listener(port: int) -> socket.socket:
    """A socket on loopback; port 0: one that is free. Raises `InputError` if it is taken."""
    server = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        server.bind((HOST, port))
    except OSError as error:
        server.close()
        raise InputError(f"--port must be a port of this machine that is free, not {port}: {error.strerror}") from None
    server.listen(1)
    return server


def serve(server: socket.socket, circuit, ends: Callable[[], bool] = lambda: False) -> None:
    """Let one host after the other talk to a `sim.backends.link.served.SerialCircuit`, which stays as each left it.

    ``ends()`` is asked between two slices, and every second while nobody is there.
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
