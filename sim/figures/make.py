"""Make the files of figures from their names: runs, pictures, films, and the numbers that they show."""

from __future__ import annotations

import importlib
import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

import matplotlib
import numpy as np

from golden.physics.scene import Scene
from golden.support.errors import InputError
from golden.support.files import atomic_file, write_text
from sim.figures import film, paper, reading, runs
from sim.figures.catalogue import FIGURES
from sim.figures.runs import Pair
from sim.support import batch

DATA = "figures.json"
DPI = 300
PICTURES = film.FRAMES + 1  # of a figure: itself and its film's


def scenes(names: list[str]) -> list[Scene]:
    """Return the scenes of these figures, each once."""
    wanted = dict.fromkeys(scene for name in names for scene in FIGURES[name].scenes)
    return [runs.load(name) for name in wanted]


def compute(loaded: list[Scene], backend: str, report_progress: Callable | None = None) -> dict[str, Pair]:
    """Return the runs of the scenes by name; `sim.support.batch.over_scenes` describes ``report_progress``."""
    pairs = batch.over_scenes(partial(runs.pair, backend=backend), loaded, report_progress)
    return {pair.scene.name: pair for pair in pairs}


def draw(name: str, pairs: dict[str, Pair], out: Path, report_progress: Callable[[int], object] | None = None) -> dict:
    """Write NAME.png, NAME.svg and NAME.gif, and return the figure's object of figures.json.

    The same runs give the same bytes. ``report_progress(pictures drawn)`` is called up to `PICTURES`.
    """
    figure = FIGURES[name]
    module = importlib.import_module(f"sim.figures.{figure.module}")
    used = [pairs[scene] for scene in figure.scenes]
    with matplotlib.rc_context(paper.SETTINGS):
        still = module.draw(used)
        for suffix, settings in (("png", {"dpi": DPI}), ("svg", {"metadata": {"Date": None}})):
            with atomic_file(out / f"{name}.{suffix}") as file:
                still.savefig(file, format=suffix, **settings)
        if report_progress:
            report_progress(1)
        film.save(
            module.film(used), out / f"{name}.gif", report_progress and (lambda drawn: report_progress(1 + drawn))
        )
    return {
        "title": figure.title,
        "backend": used[0].circuit.backend,
        "files": [f"{name}.{suffix}" for suffix in ("png", "svg", "gif")],
        "readings": [read.entry() for pair in used for read in readings(name, pair)],
        "saturated": {pair.scene.name: pair.circuit.faults for pair in used if pair.circuit.faults},
        "curves": {pair.scene.name: curves(pair) for pair in used},
    }


def readings(name: str, pair: Pair) -> list[reading.Reading]:
    """Return the readings of a figure's scene."""
    return [*FIGURES[name].read(pair), reading.apart(pair)]


def shortcomings(names: list[str], pairs: dict[str, Pair]) -> list[str]:
    """Return, in words and each once, the reasons why the figures don't pass; none if they do."""
    wrong = []
    for name in names:
        for scene in FIGURES[name].scenes:
            if faults := pairs[scene].circuit.faults:
                wrong.append(f"{scene}: saturated: {', '.join(faults)}")
            wrong += [read.shortcoming() for read in readings(name, pairs[scene]) if not read.passes]
    return list(dict.fromkeys(wrong))


def curves(pair: Pair) -> dict:
    """Return the curves of the figures in SI units; the circuit's force before its first step is unknown: null."""
    quantities = {"deformation": partial(reading.deformation, pair), "force": pair.face.force}
    if pair.scene.dim == 3:
        quantities["bulge"] = partial(reading.bulge_over_time, pair)
    result = {"t": pair.circuit.trajectory.t.tolist()}
    for name, quantity in quantities.items():
        values = (quantity(run) for run in pair.trajectories)
        result[name] = dict(zip(("circuit", "float64"), map(_numbers, values), strict=True))
    return result


def _numbers(values: np.ndarray) -> list[float | None]:
    return [value if np.isfinite(value) else None for value in values.tolist()]


def earlier(out: Path) -> dict:
    """Return the figures that an earlier call left in the folder. Raises `InputError` if their file can't be read."""
    path = out / DATA
    if not path.exists():
        return {}
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        entries = None
    if not isinstance(entries, dict):
        raise InputError(f"{path} must be what `python -m sim figures` left, not something else: remove it")
    return entries


def save(entries: dict[str, dict], out: Path) -> None:
    """Write figures.json."""
    write_text(out / DATA, json.dumps(entries, indent=1, allow_nan=False) + "\n")
