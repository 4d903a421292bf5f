"""Runs of one scene, on float64 and in the circuit's integers, and how far they are apart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from time import perf_counter

import numpy as np

from golden.physics.scene import Scene
from sim.results import energy, ranges
from sim.results import step_time as steptime
from sim.results.face import watched
from sim.run import COMPARED, LANES, UPDATES, Result, run

BOUND = {False: 1e-5, True: 5e-5}
"""Largest max_dx_rel that passes, without and with force-dependent dampers."""
STAGES = *COMPARED, "ranges"
"""What is done for a comparison, one after the other."""
INTEGERS = "fixed", "rtl", "board"
"""Backends that compute in the circuit's integers; of those that were run the last one stands for the circuit."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Runs of one scene by backend: "float", and at least one of `INTEGERS`.

    ``ranges`` is what `sim.results.ranges.of_run` gives, ``seconds`` what all took.
    """

    scene: Scene
    runs: dict[str, Result]
    ranges: list[dict]
    seconds: float

    @property
    def float64(self) -> Result:
        return self.runs["float"]

    @property
    def integers(self) -> dict[str, Result]:
        return {backend: self.runs[backend] for backend in INTEGERS if backend in self.runs}

    @property
    def circuit(self) -> Result:
        return list(self.integers.values())[-1]

    @cached_property
    def energy(self) -> dict[str, np.ndarray]:
        """`sim.results.energy.energies` of the circuit's run."""
        return energy.energies(self.scene, self.circuit.trajectory)

    def dx_rel(self) -> np.ndarray:
        """(F,) largest distance, over the nodes, between a position in integers and in float64, by object's size."""
        return dx_rel(self.scene, self.circuit, self.float64)

    def entry(self) -> dict:
        """The scene's object in compare.json."""
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
            **steptime.of_run(scene, circuit),
            "boards": steptime.on_boards(scene),
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


def compare(
    scene: Scene, *, lanes: int = LANES, updates: int = UPDATES, progress: Callable[[str, int], object] | None = None
) -> Comparison:
    """Run the scene on float64, integers and simulated circuit; ``progress(backend, steps done)`` as in `run`."""
    return completed(scene, {}, COMPARED, lanes=lanes, updates=updates, progress=progress)


def completed(
    scene: Scene,
    runs: dict[str, Result],
    backends: tuple[str, ...],
    *,
    lanes: int = LANES,
    updates: int = UPDATES,
    progress: Callable[[str, int], object] | None = None,
) -> Comparison:
    """Run the scene on those of ``backends`` that there is no run of, and look at the ranges of the integers.

    ``progress("ranges", steps done)`` comes after all runs.
    """
    began, taken = perf_counter(), sum(run.seconds for run in runs.values())

    def told(doing: str):
        if progress:
            progress(doing, 0)  # loading takes its time, the circuit's most of all
        return partial(progress, doing) if progress else None

    for backend in backends:
        if backend not in runs:
            runs = runs | {backend: run(scene, backend, lanes=lanes, updates=updates, progress=told(backend))}
    raw = next(runs[backend].raw for backend in INTEGERS if backend in runs)
    seen = ranges.of_run(scene, raw, told("ranges"))
    return Comparison(scene, runs, seen, taken + perf_counter() - began)


def dx_rel(scene: Scene, one: Result, other: Result) -> np.ndarray:
    """(F,) largest distance, over the nodes, between a position in one run and in the other, by the object's size."""
    apart = np.linalg.norm(one.trajectory.x - other.trajectory.x, axis=2)
    return apart.max(axis=1) / scene.size


def shortcomings(entry: dict) -> list[str]:
    """What keeps a scene from passing, in words; nothing when it passes."""
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
    """A small number in the shortest scientific notation, 1e-5 or 1.3e-6."""
    if x == 0 or x != x:
        return f"{x:.0f}"
    mantissa, exponent = f"{x:.1e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
