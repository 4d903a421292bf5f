"""The benchmark's results: an entry for every mesh and circuit, in build/bench.json."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable, Iterable
from pathlib import Path

from golden.datapath.rk4 import RK4
from golden.physics.scene import Scene
from golden.support.errors import InputError
from golden.support.files import write_text
from sim.speed import meshes
from sim.support.errors import about

CIRCUITS = (1, 1), (2, 1), (4, 1), (4, 2), (6, 2)
"""(lanes, updates): edge processors, and nodes updated in a cycle."""

BOARD = "ulx3s-85f"
"""The board whose timing result gives the circuit's clock, if no other is asked for."""


def bench(
    names: Iterable[str],
    cycles_per_step: Callable[[Scene, int, int], int],
    software: Callable[[Scene], dict],
    *,
    circuits: Iterable[tuple[int, int]] = CIRCUITS,
    clock: float,
) -> list[dict]:
    """Return the entries of meshes, by their names in `sim.speed.meshes`, for every circuit.

    Parameters
    ----------
    cycles_per_step
        Clock cycles of a step of (scene, lanes, updates).
    software
        Step times of programs, in the form of `sim.speed.timing.software`; called once for each mesh.
    clock
        MHz.
    """
    entries = []
    for name in names:
        scene = meshes.scene(name)
        with about(scene):
            cycles = [cycles_per_step(scene, *circuit) for circuit in circuits]
        times = software(scene)
        entries += [entry(scene, *circuit, n, clock, times) for circuit, n in zip(circuits, cycles, strict=True)]
    return entries


def entry(scene: Scene, lanes: int, updates: int, cycles: int, clock: float, software: dict[str, dict]) -> dict:
    """Return a mesh's object in bench.json for one circuit; a program's ``ratio`` is its step over the circuit's."""
    evaluations, step = RK4.stages * len(scene.mesh.edges), cycles / clock
    return {
        "mesh": scene.name,
        "lanes": lanes,
        "updates": updates,
        "nodes": len(scene.mesh.points),
        "edges": len(scene.mesh.edges),
        "clock_mhz": clock,
        "cycles_per_step": cycles,
        "occupancy": evaluations / (lanes * cycles),
        "step_us": step,
        "edge_evals_per_s": evaluations / step * 1e6,
        "software": {name: {**times, "ratio": times["step_us"] / step} for name, times in software.items()},
    }


def claim(path: Path) -> Path:
    """Make the folder of the file to write, before anything is timed. Raises `InputError` if it can't be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        reason = os.strerror(errno.EISDIR) if path.is_dir() else None
    except OSError as error:
        reason = error.strerror
    if reason:
        raise InputError(f"--out must be a file that can be written, not {path}: {reason}")
    return path


def save(entries: list[dict], path: Path) -> None:
    """Write the entries, all or none."""
    write_text(path, json.dumps(entries, indent=1, allow_nan=False) + "\n")
