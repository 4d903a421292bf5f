"""Runs that are in folders (`sim.results.store`), taken up again: by scene, as `sim.results.compare` wants them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from golden.numbers.qformat import Q
from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from golden.support.errors import InputError
from sim.encode import limits
from sim.encode.encode import Loaded
from sim.results import store
from sim.results.compare import INTEGERS
from sim.run import BACKENDS, Raw, Result

KEPT = {"seconds": (int, float), "faults": dict}
COUNTED = "cycles", "lanes", "updates"


def load(folder) -> tuple[Scene, Result]:
    """The scene and the run in a folder. Raises `InputError` as `sim.results.store.load`, and if they can't be of a
    run."""
    scene, said, kept = store.load(folder)
    backend = said.get("backend")
    if backend not in BACKENDS:
        raise _broken(folder, f"its backend is {backend!r}")
    wrong = [name for name, kind in KEPT.items() if not isinstance(said.get(name), kind)]
    wrong += [name for name in COUNTED if not isinstance(said.get(name), int | None)]
    if wrong:
        raise _broken(folder, f"{store.SUMMARY} has no {wrong[0]} that could be one")
    shape = len(scene.frames), *scene.mesh.points.shape
    shapes = {"x": shape, "v": shape, "reaction": shape, "a": (shape[0], len(scene.mesh.edges))}
    for name, wanted in shapes.items():
        values = getattr(kept, name)
        if values.shape != wanted or not (name == "reaction" or np.isfinite(values).all()):
            raise _broken(folder, f"{name} in {store.TRAJECTORY} must be {' x '.join(map(str, wanted))} finite numbers")
    result = Result(backend, kept, said["seconds"], faults=said["faults"], **{name: said[name] for name in COUNTED})
    if backend not in INTEGERS:
        return scene, result
    loaded = limits.load(scene)
    raw = integers(loaded, kept)
    if raw is None:
        raise _broken(folder, f"the state in {store.TRAJECTORY} is not one of a circuit's integers")
    return scene, Result(**vars(result) | {"raw": raw, "units": loaded.units})


def integers(loaded: Loaded, kept: Trajectory) -> Raw | None:
    """The circuit's integers from the SI units that they were kept in; None if it never had such."""
    fmt, units = loaded.image.formats, loaded.units
    x = _raw((kept.x - units.centre) / units.size, fmt.position)
    v, ratio = _raw(kept.v / units.velocity, fmt.velocity), _raw(kept.a, fmt.ratio)
    dim = kept.x.shape[2]
    exact = (
        np.array_equal(x * fmt.position.lsb * units.size + units.centre, kept.x)
        and np.array_equal(v * fmt.velocity.lsb * units.velocity, kept.v)
        and np.array_equal(ratio * fmt.ratio.lsb, kept.a)
    )
    padding = ((0, 0), (0, 0), (0, 3 - dim))
    return Raw(np.pad(x, padding), np.pad(v, padding), ratio) if exact else None


def _raw(values: np.ndarray, q: Q) -> np.ndarray:
    return np.rint(np.ldexp(values, q.frac_bits)).astype(np.int64)


def grouped(folders) -> list[tuple[Scene, dict[str, Path]]]:
    """Each scene that there are runs of, and its folders by backend; in the order in which they come.

    Raises `InputError` for a folder that `load` refuses, for two runs of a scene on the same backend, for two scenes of
    the same name, and for a scene without a run in the circuit's integers.
    """
    groups: dict[str, tuple[Scene, dict[str, Path]]] = {}
    for folder in map(Path, folders):
        scene, result = load(folder)
        _, runs = groups.setdefault(scene.name, (scene, {}))
        if result.backend in runs:
            raise InputError(
                f"RUN must be one of each backend for a scene, not two on {result.backend} of "
                f"{scene.name!r}: {runs[result.backend]} and {folder}"
            )
        for other in list(runs.values())[:1]:
            if not _same(other / store.SCENE, folder / store.SCENE):
                raise InputError(
                    f"RUN must be of one scene where the name is one, not of two that are called "
                    f"{scene.name!r}: {other} and {folder}"
                )
        runs[result.backend] = folder
    for name, (_, runs) in groups.items():
        if not runs.keys() & set(INTEGERS):
            raise InputError(
                f"RUN must be one on {', '.join(INTEGERS[:-1])} or {INTEGERS[-1]} for the scene {name!r} "
                f"as well, not only {', '.join(map(str, runs.values()))}"
            )
    return list(groups.values())


def _same(one: Path, other: Path) -> bool:
    with np.load(one) as a, np.load(other) as b:
        return set(a) == set(b) and all(np.array_equal(a[name], b[name]) for name in a)


def _broken(folder, reason: str) -> InputError:
    return InputError(f"RUN must be a folder as `python -m sim run` left it, not {folder}: {reason}")
