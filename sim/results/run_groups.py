"""Runs in folders, grouped by their scene for a comparison."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from golden.physics.scene import Scene
from golden.support.errors import InputError
from sim.backends.registry import integer_backends
from sim.results import run_folder


def group_by_scene(folders) -> list[tuple[Scene, dict[str, Path]]]:
    """Return each scene that there are runs of with its folders by backend, in the order in which they come.

    Raises `InputError` for a folder that `sim.results.run_folder.load_result` refuses, for two runs of a scene on the
    same backend, for two scenes of the same name, and for a scene without a run in the circuit's integers.
    """
    groups: dict[str, tuple[Scene, dict[str, Path]]] = {}
    for folder in map(Path, folders):
        scene, result = run_folder.load_result(folder)
        _, runs = groups.setdefault(scene.name, (scene, {}))
        if result.backend in runs:
            raise InputError(
                f"RUN must be one of each backend for a scene, not two on {result.backend} of "
                f"{scene.name!r}: {runs[result.backend]} and {folder}"
            )
        for other in list(runs.values())[:1]:
            if not _same(other / run_folder.SCENE, folder / run_folder.SCENE):
                raise InputError(
                    f"RUN must be of one scene where the name is one, not of two that are called "
                    f"{scene.name!r}: {other} and {folder}"
                )
        runs[result.backend] = folder
    for name, (_, runs) in groups.items():
        _check_integers(name, runs)
    return list(groups.values())


def _check_integers(name: str, runs: dict[str, Path]) -> None:
    *others, last = integer_backends()
    if not runs.keys() & {*others, last}:
        raise InputError(
            f"RUN must be one on {', '.join(others)} or {last} for the scene {name!r} "
            f"as well, not only {', '.join(map(str, runs.values()))}"
        )


def _same(one: Path, other: Path) -> bool:
    with np.load(one) as a, np.load(other) as b:
        return set(a) == set(b) and all(np.array_equal(a[name], b[name]) for name in a)
