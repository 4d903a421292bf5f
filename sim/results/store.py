"""What `python -m sim run` leaves in its folder."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import numpy as np

from golden.physics import trajectory
from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from golden.scene import archive
from golden.support.errors import InputError
from golden.support.files import write_text
from sim.run import Result

SCENE, TRAJECTORY, SUMMARY = "scene.npz", "trajectory.npz", "summary.json"


def save(scene: Scene, result: Result, folder: Path) -> None:
    """Write ``scene.npz``, ``trajectory.npz`` and, when these are complete, ``summary.json``; an earlier run's goes."""
    (folder / SUMMARY).unlink(missing_ok=True)
    archive.save(scene, folder / SCENE)
    result.trajectory.save(folder / TRAJECTORY)
    write_text(folder / SUMMARY, json.dumps(summary(scene, result), indent=2, allow_nan=False) + "\n")


def load(folder) -> tuple[Scene, dict, Trajectory]:
    """What `save` wrote: the scene (its ``path`` is the file in the folder), the summary's object, the trajectory.

    Raises `InputError` for a folder without such files, or with one that is damaged or of another run.
    """
    folder = Path(folder)
    for name in (SUMMARY, SCENE, TRAJECTORY):
        if not (folder / name).is_file():
            raise InputError(f"RUN must be a folder that `python -m sim run` left, not {folder}: it has no {name}")
    said = _read(folder / SUMMARY, lambda path: dict(json.loads(path.read_text(encoding="utf-8"))))
    scene = _read(folder / SCENE, archive.load)
    kept = _read(folder / TRAJECTORY, trajectory.load)
    same = np.array_equal(kept.edges, scene.mesh.edges) and np.array_equal(kept.t, scene.frames * scene.dt)
    if not same or said.get("scene") != scene.name:
        raise InputError(
            f"RUN must be a folder with the files of one run, not {folder}: "
            f"{SCENE}, {TRAJECTORY} and {SUMMARY} differ in what they are of"
        )
    return scene, said, kept


def _read(path: Path, read):
    try:
        return read(path)
    except (OSError, EOFError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
        raise InputError(
            f"{path} must be as `python -m sim run` wrote it: it cannot be read ({type(error).__name__})"
        ) from error


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
        "units": units
        and {
            "length": units.size,
            "time": units.dt,
            "velocity": units.velocity,
            "force": units.force,
        },
        "lanes": result.lanes,
        "updates": result.updates,
        "cycles": result.cycles,
        "seconds": round(result.seconds, 3),
    }
