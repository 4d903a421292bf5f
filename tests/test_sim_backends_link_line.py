"""A serial line over a socket whose other side disappears."""

import gc
import socket
import struct

import pytest

from sim.backends.link.errors import LineBroken
from sim.backends.link.line import SerialLine


@pytest.fixture
def ends():
    """Give (a line, the other side's socket)."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        line = SerialLine(f"socket://127.0.0.1:{server.getsockname()[1]}", 115_200)
        other, _ = server.accept()
        with other:
            yield line, other
        line.close()


def test_bytes_go_both_ways(ends):
    line, other = ends
    line.write(b"abc")
    assert other.recv(3) == b"abc"
    other.sendall(b"de")
    assert line.read(1.0) + line.read(0.1) == b"de"


def test_a_line_that_was_reset_is_an_error_and_leaves_no_open_socket(ends):
    line, other = ends
    other.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # close with a reset
    other.close()
    with pytest.raises(LineBroken, match=f"--port must stay connected, but {line.url} is gone: "):
        line.read(1.0)
    line.close()
    gc.collect()  # a socket that is still open is a ResourceWarning, which pytest makes an error
