"""The folder of a run: written by ``python -m sim run``, read by what looks at the run later."""

from __future__ import annotations

import json
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from golden.numbers.qformat import Q
from golden.physics import trajectory
from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from golden.scene import archive
from golden.support.errors import InputError
from golden.support.files import write_text
from sim.backends.registry import BACKENDS
from sim.encode import limits
from sim.encode.encode import EncodedScene
from sim.results.result import Raw, Result

SCENE, TRAJECTORY, SUMMARY = "scene.npz", "trajectory.npz", "summary.json"
COUNTED = "cycles", "lanes", "updates"


def save(scene: Scene, result: Result, folder: Path) -> None:
    """Write ``scene.npz``, ``trajectory.npz`` and, when these are complete, ``summary.json``; an earlier run's goes."""
    (folder / SUMMARY).unlink(missing_ok=True)
    archive.save(scene, folder / SCENE)
    result.trajectory.save(folder / TRAJECTORY)
    write_text(folder / SUMMARY, json.dumps(summary(scene, result), indent=2, allow_nan=False) + "\n")


def summary(scene: Scene, result: Result) -> dict:
    """Return what was run and how it went, in plain numbers (SI units)."""
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


def load(folder) -> tuple[Scene, dict, Trajectory]:
    """Return what `save` wrote: the scene (its ``path`` is the file in the folder), the summary's object, the
    trajectory.

    Raises `InputError` for a folder without such files, or with one that is damaged or of another run.
    """
    folder = Path(folder)
    for name in (SUMMARY, SCENE, TRAJECTORY):
        if not (folder / name).is_file():
            raise InputError(f"RUN must be a folder that `python -m sim run` left, not {folder}: it has no {name}")
    entry = _read(folder / SUMMARY, lambda path: dict(json.loads(path.read_text(encoding="utf-8"))))
    scene = _read(folder / SCENE, archive.load)
    frames = _read(folder / TRAJECTORY, trajectory.load)
    same = np.array_equal(frames.edges, scene.mesh.edges) and np.array_equal(frames.t, scene.frames * scene.dt)
    if not same or entry.get("scene") != scene.name:
        raise InputError(
            f"RUN must be a folder with the files of one run, not {folder}: "
            f"{SCENE}, {TRAJECTORY} and {SUMMARY} differ in what they are of"
        )
    return scene, entry, frames


def load_result(folder) -> tuple[Scene, Result]:
    """Return the scene and the result of the run in a folder, with the circuit's integers where it had them.

    Raises `InputError` as `load`, and for files that no run can have left.
    """
    scene, entry, frames = load(folder)
    backend = entry.get("backend")
    if backend not in BACKENDS:
        raise _broken(folder, f"its backend is {backend!r}")
    expected = {"seconds": int | float, "faults": dict} | dict.fromkeys(COUNTED, int | None)
    for name, kind in expected.items():
        if not isinstance(entry.get(name), kind):
            raise _broken(folder, f"{SUMMARY} has no {name} that could be one")
    _check_frames(scene, frames, folder)
    result = Result(
        backend, frames, entry["seconds"], faults=entry["faults"], **{name: entry[name] for name in COUNTED}
    )
    if not BACKENDS[backend].integers:
        return scene, result
    encoded = limits.encode_checked(scene)
    raw = raw_frames(encoded, frames)
    if raw is None:
        raise _broken(folder, f"the state in {TRAJECTORY} is not one of a circuit's integers")
    return scene, replace(result, raw=raw, units=encoded.units)


def raw_frames(encoded: EncodedScene, frames: Trajectory) -> Raw | None:
    """Return the circuit's integers from the SI units that they were kept in; None if they never were such."""
    fmt, units = encoded.image.formats, encoded.units
    x = _round((frames.x - units.centre) / units.size, fmt.position)
    v, ratio = _round(frames.v / units.velocity, fmt.velocity), _round(frames.a, fmt.ratio)
    exact = (
        np.array_equal(x * fmt.position.lsb * units.size + units.centre, frames.x)
        and np.array_equal(v * fmt.velocity.lsb * units.velocity, frames.v)
        and np.array_equal(ratio * fmt.ratio.lsb, frames.a)
    )
    padding = ((0, 0), (0, 0), (0, 3 - frames.x.shape[2]))
    return Raw(np.pad(x, padding), np.pad(v, padding), ratio) if exact else None


def _round(values: np.ndarray, q: Q) -> np.ndarray:
    """Return the integers nearest to values that are integers but for the errors of float64."""
    return np.rint(np.ldexp(values, q.frac_bits)).astype(np.int64)


def _check_frames(scene: Scene, frames: Trajectory, folder) -> None:
    """Raise `InputError` for frames of another shape than the scene's, or not finite; a reaction may be unknown."""
    shape = len(scene.frames), *scene.mesh.points.shape
    for name, values, wanted, finite in (
        ("x", frames.x, shape, True),
        ("v", frames.v, shape, True),
        ("reaction", frames.reaction, shape, False),
        ("a", frames.a, (shape[0], len(scene.mesh.edges)), True),
    ):
        if values.shape != wanted or (finite and not np.isfinite(values).all()):
            raise _broken(folder, f"{name} in {TRAJECTORY} must be {' x '.join(map(str, wanted))} finite numbers")


def _read(path: Path, read):
    try:
        return read(path)
    except (OSError, EOFError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
        raise InputError(
            f"{path} must be as `python -m sim run` wrote it: it cannot be read ({type(error).__name__})"
        ) from error


def _broken(folder, reason: str) -> InputError:
    return InputError(f"RUN must be a folder as `python -m sim run` left it, not {folder}: {reason}")
