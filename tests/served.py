"""A small simulated circuit with its serial pins on a socket, or on a line that damages bytes."""

import contextlib
import threading

import numpy as np

from hw.link.items import Items
from hw.parameters import Parameters
from sim.backends.link import serve
from sim.backends.link.served import BAUD, CLOCK_HZ, SerialCircuit
from sim.backends.rtl import BUILD

SMALL = Parameters(lanes=1, nodes=32, edges=64, materials=2, tables=1)
ITEMS = Items.of_word(SMALL.formats.state)


def serial_circuit(parameters=SMALL, **kwargs) -> SerialCircuit:
    return SerialCircuit(parameters, clock_hz=CLOCK_HZ, baud=BAUD, folder=BUILD, **kwargs)


class Service:
    """A service at ``url``; ``stop()`` disconnects its host."""

    def __init__(self, circuit):
        self._server, self._ended = serve.listener(0), threading.Event()
        self.url = f"socket://{serve.HOST}:{self._server.getsockname()[1]}"
        self._thread = threading.Thread(target=serve.serve, args=(self._server, circuit, self._ended.is_set))
        self._thread.start()

    def stop(self):
        self._ended.set()
        self._thread.join()
        self._server.close()


@contextlib.contextmanager
def served(parameters=SMALL):
    circuit = serial_circuit(parameters)
    service = Service(circuit)
    try:
        yield service
    finally:
        service.stop()
        circuit.close()


class NoisyLine:
    """A line to a `SerialCircuit`, in simulated time; a share of the bytes each way is changed, lost or doubled."""

    SLICE = 200
    url = "simulated"

    def __init__(self, circuit, rng: np.random.Generator, share: float):
        self._circuit, self._rng, self.share = circuit, rng, share
        self._waiting, self.damaged = b"", 0

    def clock(self) -> float:
        return self._circuit.clock / CLOCK_HZ

    def write(self, data: bytes):
        self._waiting += self._damage(data)

    def read(self, seconds: float) -> bytes:
        until = self.clock() + seconds
        while self.clock() < until:
            data, self._waiting = self._waiting, b""
            if out := self._circuit.run(data, self.SLICE):
                return self._damage(out)
        return b""

    def close(self):
        pass

    def _damage(self, data: bytes) -> bytes:
        out = bytearray()
        for byte in data:
            what = int(self._rng.integers(3)) if self._rng.random() < self.share else None
            self.damaged += what is not None
            out += bytes({None: [byte], 0: [int(self._rng.integers(256))], 1: [], 2: [byte, byte]}[what])
        return bytes(out)
