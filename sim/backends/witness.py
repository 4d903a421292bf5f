"""The NumPy model as a witness: it computes single steps of a compiled machine again."""

from __future__ import annotations

import numpy as np

from golden.datapath import machine as golden
from golden.datapath.memory_image import MemoryImage
from golden.support.errors import InternalError
from sim.backends.machine import Machine


class Witness:
    """Computes single steps of another machine again and insists on the same bits."""

    def __init__(self, image: MemoryImage):
        self._model = golden.Machine(image)

    def step(self, machine: Machine, number: int) -> None:
        """Let ``machine`` do step ``number``. Raises `InternalError` when the NumPy model gets another result."""
        model, faults = self._model, machine.faults.copy()
        model.x, model.ratio = machine.x.copy(), machine.ratio.copy()
        model.restart(machine.v)
        model.faults.clear()
        machine.step(1)
        model.step(1)
        pairs = {
            "x": (model.x, machine.x),
            "v": (model.v, machine.v),
            "ratio": (model.ratio, machine.ratio),
            "force": (model.force, machine.force),
        }
        differing = [name for name, pair in pairs.items() if not np.array_equal(*pair)]
        if machine.faults - faults != model.faults:
            differing.append("faults")
        if differing:
            raise InternalError(
                f"the compiled integer model and the NumPy model differ in {', '.join(differing)} after step {number}"
            )
