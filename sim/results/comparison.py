"""A comparison of one scene's runs: how far float64 and the circuit's integers are apart, and what passes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from golden.physics.scene import Scene
from sim.backends.float64 import FloatBackend
from sim.backends.registry import integer_backends
from sim.results import energy, step_time
from sim.results.face import watched
from sim.results.result import Result

BOUND = {False: 1e-5, True: 5e-5}
"""Largest max_dx_rel that passes, without and with force-dependent dampers."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Runs of one scene by backend: on float64, and on at least one that computes in the circuit's integers.

    ``ranges`` is what `sim.results.ranges.measure` gives, ``seconds`` the time of all runs.
    """

    scene: Scene
    runs: dict[str, Result]
    ranges: list[dict]
    seconds: float

    @property
    def float64(self) -> Result:
        """The run on float64."""
        return self.runs[FloatBackend.name]

    @property
    def integers(self) -> dict[str, Result]:
        """The runs in integers, the closest to hardware last."""
        return {backend: self.runs[backend] for backend in integer_backends() if backend in self.runs}

    @property
    def circuit(self) -> Result:
        """The run that stands for the circuit: the last one in integers."""
        return list(self.integers.values())[-1]

    @cached_property
    def energy(self) -> dict[str, np.ndarray]:
        """`sim.results.energy.energies` of the circuit's run."""
        return energy.energies(self.scene, self.circuit.trajectory)

    def dx_rel(self) -> np.ndarray:
        """Return (F,) the largest distance of a node in integers from its position in float64, over the object's
        size."""
        return dx_rel(self.scene, self.circuit, self.float64)

    def entry(self) -> dict:
        """Return the scene's object in compare.json."""
        scene, dx, circuit = self.scene, self.dx_rel(), self.circuit
        first, *others = self.integers.values()
        return {
            "scene": scene.name,
            "dim": scene.dim,
            "force_dependent": scene.force_dependent,
            "nodes": len(scene.mesh.points),
            "edges": len(scene.mesh.edges),
            "steps": scene.steps,
            "dt": scene.dt,
            "backends": list(self.runs),
            "lanes": circuit.lanes,
            "updates": circuit.updates,
            "cycles": circuit.cycles,
            **step_time.count(scene, circuit),
            "boards": step_time.on_boards(scene),
            "rtl_equals_fixed": all(other.raw.same(first.raw) for other in others) if others else None,
            "max_dx_rel": float(dx.max()),
            "final_dx_rel": float(dx[-1]),
            "bound": BOUND[scene.force_dependent],
            "recovery": watched(scene).recovery(scene, circuit.trajectory),
            "max_da": float(np.abs(circuit.trajectory.a - self.float64.trajectory.a).max()),
            "energy": {name: float(values[-1]) for name, values in self.energy.items()},
            "saturations": max(run.saturations for run in self.integers.values()),
            "faults": {backend: run.faults for backend, run in self.integers.items()},
            "ranges": self.ranges,
            "seconds": round(self.seconds, 2),
        }


def dx_rel(scene: Scene, one: Result, other: Result) -> np.ndarray:
    """Return (F,) the largest distance of a node in one run from its position in the other, over the object's size."""
    apart = np.linalg.norm(one.trajectory.x - other.trajectory.x, axis=2)
    return apart.max(axis=1) / scene.size


def shortcomings(entry: dict) -> list[str]:
    """Return what keeps a scene from passing, in words; nothing when it passes."""
    wrong = []
    if entry["rtl_equals_fixed"] is False:
        wrong.append("the circuit's frames differ from the integer model's")
    if entry["saturations"]:
        names = sorted({name for faults in entry["faults"].values() for name in faults})
        wrong.append(f"saturated: {', '.join(names)}")
    if not entry["max_dx_rel"] <= entry["bound"]:
        wrong.append(f"max_dx_rel must be at most {power(entry['bound'])}, not {power(entry['max_dx_rel'])}")
    return wrong


def power(x: float) -> str:
    """Return a small number in the shortest scientific notation, 1e-5 or 1.3e-6."""
    if x == 0 or x != x:
        return f"{x:.0f}"
    mantissa, exponent = f"{x:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
