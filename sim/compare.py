"""A scene on float64, on the integer model and on the simulated circuit, and how far they are apart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np

from golden.problem import Scene
from sim.face import watched
from sim.run import COMPARED, LANES, UPDATES, Result, run

BOUND = {False: 1e-5, True: 5e-5}
"""Largest max_dx_rel that passes, without and with force-dependent dampers."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Three runs of one scene."""

    scene: Scene
    float64: Result
    fixed: Result
    rtl: Result
    seconds: float

    def dx_rel(self) -> np.ndarray:
        """(F,) largest distance, over the nodes, between a position in integers and in float64, by object's size."""
        return dx_rel(self.scene, self.fixed, self.float64)

    def entry(self) -> dict:
        """The scene's object in compare.json."""
        scene, dx = self.scene, self.dx_rel()
        return {
            "scene": scene.name,
            "dim": scene.dim,
            "force_dependent": scene.force_dependent,
            "nodes": len(scene.mesh.points),
            "edges": len(scene.mesh.edges),
            "steps": scene.steps,
            "dt": scene.dt,
            "lanes": self.rtl.lanes,
            "updates": self.rtl.updates,
            "cycles": self.rtl.cycles,
            "rtl_equals_fixed": self.rtl.raw.same(self.fixed.raw),
            "max_dx_rel": float(dx.max()),
            "final_dx_rel": float(dx[-1]),
            "bound": BOUND[scene.force_dependent],
            "recovery": watched(scene).recovery(scene, self.rtl.trajectory),
            "max_da": float(np.abs(self.fixed.trajectory.a - self.float64.trajectory.a).max()),
            "saturations": self.fixed.saturations or self.rtl.saturations,
            "faults": {"fixed": self.fixed.faults, "rtl": self.rtl.faults},
            "seconds": round(self.seconds, 2),
        }


def compare(scene: Scene, *, lanes: int = LANES, updates: int = UPDATES,
            progress: Callable[[str, int], object] | None = None) -> Comparison:
    """Run the scene on the three backends; ``progress(backend, steps done)`` as in `run`."""
    began, results = perf_counter(), []
    for backend in COMPARED:
        told = partial(progress, backend) if progress else None
        if told:
            told(0)  # loading takes its time, the circuit's most of all
        results.append(run(scene, backend, lanes=lanes, updates=updates, progress=told))
    return Comparison(scene, *results, perf_counter() - began)


def dx_rel(scene: Scene, one: Result, other: Result) -> np.ndarray:
    """(F,) largest distance, over the nodes, between a position in one run and in the other, by the object's size."""
    apart = np.linalg.norm(one.trajectory.x - other.trajectory.x, axis=2)
    return apart.max(axis=1) / scene.size


def shortcomings(entry: dict) -> list[str]:
    """What keeps a scene from passing, in words; nothing when it passes."""
    wrong = []
    if not entry["rtl_equals_fixed"]:
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
