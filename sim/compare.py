"""Runs of one scene side by side: on float64, on the integer model and in the simulated circuit."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from time import perf_counter

from golden.physics.scene import Scene
from sim.backends.registry import compared_backends, integer_backends
from sim.backends.rtl import LANES, UPDATES
from sim.results import ranges
from sim.results.comparison import Comparison
from sim.results.result import Result
from sim.run import run

RANGES = "ranges"
"""The last stage of a comparison, after the runs: measuring the ranges of the integers."""


def compare(
    scene: Scene, *, lanes: int = LANES, updates: int = UPDATES, progress: Callable[[str, int], object] | None = None
) -> Comparison:
    """Run the scene on all backends that are compared; ``progress(backend, steps done)`` as in `complete`."""
    return complete(scene, {}, compared_backends(), lanes=lanes, updates=updates, progress=progress)


def complete(
    scene: Scene,
    runs: dict[str, Result],
    backends: tuple[str, ...],
    *,
    lanes: int = LANES,
    updates: int = UPDATES,
    progress: Callable[[str, int], object] | None = None,
) -> Comparison:
    """Run the scene on each of ``backends`` that ``runs`` lacks, and measure the ranges of the integers.

    ``progress(backend, steps done)`` is called as by `sim.run.run`, and with `RANGES` after all runs.
    """
    began, taken = perf_counter(), sum(run.seconds for run in runs.values())

    def report_progress(stage: str):
        if progress:
            progress(stage, 0)  # loading takes its time, the circuit's most of all
        return partial(progress, stage) if progress else None

    for backend in backends:
        if backend not in runs:
            result = run(scene, backend, lanes=lanes, updates=updates, progress=report_progress(backend))
            runs = runs | {backend: result}
    raw = next(runs[backend].raw for backend in integer_backends() if backend in runs)
    seen = ranges.measure(scene, raw, report_progress(RANGES))
    return Comparison(scene, runs, seen, taken + perf_counter() - began)
