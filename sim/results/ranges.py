"""The range of each quantity of the datapath in a run: how much of its format it uses, and its headroom."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import log2

import numpy as np

from golden.datapath.machine import Machine
from golden.datapath.quantities import QUANTITIES
from golden.physics.scene import Scene
from sim.encode import limits
from sim.encode.switch import switch
from sim.encode.units import Units
from sim.results.result import Raw

MEASURED = {name for name, quantity in QUANTITIES.items() if quantity.measured}

SAMPLES = 100
"""Number of steps of a run that are sampled, unless it has fewer frames or more phases."""


class Ranges:
    """A histogram of the bits that each quantity's numbers take: the ``watch`` of a `golden.datapath.machine.Machine`.

    Attributes
    ----------
    counts : dict of str to (bits + 1,) int64
        How many numbers took 0, 1, 2 ... bits, sign excluded: a number of n bits is from 2**(n - 1) up to 2**n.
    largest : dict of str to int
        Largest magnitude, as an integer.
    formats : dict of str to Q
    """

    def __init__(self):
        self.counts, self.largest, self.formats = {}, {}, {}

    def __call__(self, values: dict) -> None:
        for name in MEASURED & values.keys():
            vector = values[name] if isinstance(values[name], list) else [values[name]]
            magnitude = np.abs(np.concatenate([np.atleast_1d(number.raw) for number in vector]))
            q = self.formats.setdefault(name, vector[0].fmt)
            bits = np.bincount(np.frexp(magnitude.astype(float))[1], minlength=q.width + 1)
            self.counts[name] = self.counts.get(name, 0) + bits
            self.largest[name] = max(self.largest.get(name, 0), int(magnitude.max()))

    def entries(self, units: Units) -> list[dict]:
        """Return an entry of compare.json for each quantity, in their order."""
        return [self._entry(name, units) for name in QUANTITIES if name in self.counts]

    def _entry(self, name: str, units: Units) -> dict:
        q, largest, quantity = self.formats[name], self.largest[name], QUANTITIES[name]
        full = 1 << q.width - q.signed
        one, unit = (1.0, "") if quantity.normalised else in_si(q.unit, units)
        return {
            "quantity": name,
            "words": quantity.words,
            "format": str(q),
            "bits": q.width,
            "signed": q.signed,
            "normalised": quantity.normalised,
            "largest": None if quantity.normalised else largest * q.lsb * one,
            "unit": unit,
            "headroom_bits": round(log2(full / largest), 3) if largest else None,
            "counts": self.counts[name].tolist(),
        }


def in_si(unit: str, units: Units) -> tuple[float, str]:
    """Return a format's unit in SI. Trial forces of several materials have no common one: then it is the full scale."""
    trial = (units.trial[0], "N") if len(set(units.trial)) == 1 else (1.0, "full scale")
    return {
        "size": (units.size, "m"),
        "size/step": (units.size, "m"),
        "velocity full scale": (units.velocity, "m/s"),
        "force full scale": (units.force, "N"),
        "trial full scale": trial,
        "1": (1.0, ""),
    }[unit]


def sampled(scene: Scene) -> np.ndarray:
    """Return the frames from which a step is sampled: evenly spread, and those at which a phase starts."""
    frames = np.linspace(0, len(scene.frames) - 2, min(SAMPLES, len(scene.frames) - 1)).round().astype(int)
    starts = np.cumsum([0] + [phase.steps for phase in scene.phases[:-1]])
    return np.union1d(frames, np.searchsorted(scene.frames, starts))


def measure(scene: Scene, raw: Raw, progress: Callable[[int], object] | None = None) -> list[dict]:
    """Return an entry for each quantity: its ranges in the step after each frame of `sampled`, from the run's state.

    ``progress`` is called with the step that was reached.
    """
    ranges, encoded, begun = Ranges(), limits.encode_checked(scene), None
    machine = Machine(encoded.image, ranges)
    for frame, phase in _with_phase(scene):
        machine.x, machine.v = raw.x[frame][encoded.node_order], raw.v[frame][encoded.node_order]
        machine.ratio = raw.ratio[frame][encoded.edge_order]
        if phase is not begun and phase.materials:
            encoded = switch(encoded, machine, phase.materials)
        begun = phase
        machine.restart(encoded.start(phase, machine.v))
        machine.step()
        if progress:
            progress(int(scene.frames[frame]) + 1)
    return ranges.entries(encoded.units)


def _with_phase(scene: Scene) -> Iterator[tuple]:
    """Yield each sampled frame with the phase that goes on or starts there."""
    ends = np.cumsum([phase.steps for phase in scene.phases])
    for frame in sampled(scene):
        yield frame, scene.phases[np.searchsorted(ends, scene.frames[frame], side="right")]
