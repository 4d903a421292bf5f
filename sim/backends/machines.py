"""The integer machines behind one face: NumPy model, compiled model, simulated circuit.

A machine has the attributes ``x, v`` (N, 3), ``ratio`` (E,), ``force`` (N, 3), int64 in the circuit's order, and
``faults`` (name -> count); ``restart(v)`` takes up the image's loads and masses and these velocities, ``step(n)``
runs n steps.
"""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path

import numpy as np

from golden.datapath.image import Image
from golden.datapath.machine import Machine
from golden.support import paths
from golden.support.errors import InputError, InternalError

BUILD = paths.BUILD / "rtl"
ENGINES = "native", "numpy"


@contextmanager
def integer_model(image: Image, engine: str):
    if engine == "numpy":
        yield Machine(image)
    else:
        from sim.backends.native import NativeMachine

        yield NativeMachine(image)


def parameters(lanes: int, updates: int):
    """The circuit that is simulated. Raises `InputError` for a number of lanes or of updates that it can't have."""
    from hw.parameters import Parameters

    try:
        return Parameters(lanes=lanes, updates=updates)
    except ValueError as error:
        raise InputError(str(error)) from None


def check_room(image: Image, parameters):
    """Raise `InputError` for an object that is larger than the circuit."""
    from sim.encode.program import Program

    Program(image, parameters)


@contextmanager
def circuit(image: Image, parameters, waves: Path | None):
    from sim.backends.circuit import CircuitMachine
    from sim.backends.rtl import Circuit  # Amaranth and Verilator are slow to load

    check_room(image, parameters)
    simulated = Circuit(parameters, BUILD, waves)
    try:
        yield CircuitMachine(image, simulated)
    finally:
        simulated.close()


@contextmanager
def board(image: Image, link):
    """The circuit behind a `sim.backends.link.board.Board`."""
    from sim.backends.circuit import CircuitMachine

    try:
        try:
            check_room(image, link.parameters)
        except InputError as error:
            raise InputError(f"{error}: choose a smaller object, or build a circuit that holds it") from None
        yield CircuitMachine(image, link, verify=link.verify)
    finally:
        link.close()


class Witness:
    """Computes single steps of another machine again, with the NumPy model, and insists on the same bits."""

    def __init__(self, image: Image):
        self._model = Machine(image)

    def step(self, machine, number: int):
        """Let ``machine`` do step ``number``. Raises `InternalError` when the NumPy model gets another result."""
        model, faults = self._model, machine.faults.copy()
        model.x, model.ratio = machine.x.copy(), machine.ratio.copy()
        model.restart(machine.v)
        model.faults.clear()
        machine.step(1)
        model.step(1)
        differing = [
            name
            for name in ("x", "v", "ratio", "force")
            if not np.array_equal(getattr(model, name), getattr(machine, name))
        ]
        if machine.faults - faults != model.faults:
            differing.append("faults")
        if differing:
            raise InternalError(
                f"the compiled integer model and the NumPy model differ in {', '.join(differing)} after step {number}"
            )
