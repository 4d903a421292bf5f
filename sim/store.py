"""What `python -m sim run` leaves in its folder."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from golden.files import write_text
from golden.problem import Scene
from sim.run import Result


def save(scene: Scene, result: Result, folder: Path) -> None:
    """Write ``trajectory.npz`` and then, when that is complete, ``summary.json``."""
    result.trajectory.save(folder / "trajectory.npz")
    write_text(folder / "summary.json", json.dumps(summary(scene, result), indent=2, allow_nan=False) + "\n")


def summary(scene: Scene, result: Result) -> dict:
    """What was run and how it went, in plain numbers (SI units)."""
    x, units = result.trajectory.x, result.units
    return {
        "scene": scene.name,
        "backend": result.backend,
        "dim": scene.dim,
        "force_dependent": scene.force_dependent,
        "nodes": len(scene.mesh.points),
        "edges": len(scene.mesh.edges),
        "size": scene.size,
        "steps": scene.steps,
        "dt": scene.dt,
        "frames": len(scene.frames),
        "phases": [{"name": phase.name, "steps": phase.steps} for phase in scene.phases],
        "largest_displacement": float(np.linalg.norm(x - x[0], axis=2).max()),
        "final_displacement": float(np.linalg.norm(x[-1] - x[0], axis=1).max()),
        "saturations": result.saturations,
        "faults": result.faults,
        "units": units and {
            "length": units.size, "time": units.dt, "velocity": units.velocity, "force": units.force,
        },
        "lanes": result.lanes,
        "updates": result.updates,
        "cycles": result.cycles,
        "seconds": round(result.seconds, 3),
    }
