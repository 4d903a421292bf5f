"""The backends that there are, by name: adding one is adding a module and its class here."""

from __future__ import annotations

from sim.backends.backend import Backend
from sim.backends.board import BoardBackend
from sim.backends.fixed import FixedBackend
from sim.backends.float64 import FloatBackend
from sim.backends.rtl import RtlBackend

BACKENDS: dict[str, type[Backend]] = {
    backend.name: backend for backend in (FloatBackend, FixedBackend, RtlBackend, BoardBackend)
}


def compared_backends() -> tuple[str, ...]:
    """Return the names of the backends that a comparison runs."""
    return tuple(name for name, backend in BACKENDS.items() if backend.compared)


def integer_backends() -> tuple[str, ...]:
    """Return the names of the backends that compute in the circuit's integers; the later, the closer to hardware."""
    return tuple(name for name, backend in BACKENDS.items() if backend.integers)


def owners(setting: str) -> str:
    """Return the names of the backends with this setting, for a sentence."""
    return " or ".join(name for name, backend in BACKENDS.items() if setting in backend.settings())
