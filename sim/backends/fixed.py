"""The backend that computes with the circuit's integer model, in software."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from golden.datapath import machine as golden
from golden.datapath.memory_image import MemoryImage
from golden.support.errors import InputError
from sim.backends.backend import IntegerBackend
from sim.backends.machine import Machine
from sim.backends.witness import Witness
from sim.encode.encode import EncodedScene

NATIVE, NUMPY = ENGINES = "native", "numpy"


@dataclass(frozen=True)
class FixedBackend(IntegerBackend):
    """The integer model: compiled ("native"), with single steps computed again by NumPy, or NumPy alone ("numpy")."""

    engine: str = NATIVE

    name = "fixed"
    words = "integer model"
    summary = "the circuit's integer model"
    compared = True

    def check(self) -> None:
        """Raise `InputError` for an unknown engine."""
        if self.engine not in ENGINES:
            raise InputError(f"engine must be one of {', '.join(ENGINES)}, not {self.engine!r}")

    @contextmanager
    def open(self, encoded: EncodedScene) -> Iterator[Machine]:
        """Give the model, loaded."""
        if self.engine == NUMPY:
            yield golden.Machine(encoded.image)
        else:
            from sim.backends.native import NativeMachine

            yield NativeMachine(encoded.image)

    def witness(self, image: MemoryImage) -> Witness | None:
        """Return the NumPy model of an image, beside the compiled one."""
        return None if self.engine == NUMPY else Witness(image)
