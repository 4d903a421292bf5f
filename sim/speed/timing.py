"""Step times of the software on this machine, each step timed by itself."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter, perf_counter_ns, process_time

import numpy as np

from golden.physics.model import Model
from golden.physics.scene import Scene
from sim.speed.compiled import CompiledModel
from sim.speed.meshes import LAP
from sim.speed.threads import idle
from sim.support.batch import cores

SOFTWARE = {
    "numpy": "golden model, NumPy in float64",
    "numba_1_thread": "compiled by Numba in float32, one thread",
    "numba_all_threads": "compiled by Numba in float32, one thread a core",
}
"""The timed programs, and their description."""

WARM = 200  # steps before the timed ones: to compile, to fill caches, and to raise the cores' clock


def software(scene: Scene, steps: int = LAP, progress: Callable[[str], object] | None = None) -> dict[str, dict]:
    """Return the step times of the golden model (float64) and of the compiled one (float32).

    The object is put back at its start every `LAP` steps.

    Parameters
    ----------
    progress
        Called with a name of `SOFTWARE` before it is timed.

    Returns
    -------
    dict
        For each name of `SOFTWARE`: ``threads``, ``steps``, and in us ``step_us`` (median), ``p999_us`` (99.9th
        percentile), ``max_us``, ``clock_us`` (the part of it that reading the clock takes, median); ``running``, the
        part of the time in which its threads had a core each: less than 1 when others use the machine.
    """
    threads = {"numpy": 1, "numba_1_thread": 1, "numba_all_threads": cores()}
    figures = {}
    for name, count in threads.items():
        if progress:
            progress(name)
        taken, cpu, wall = [], 0.0, 0.0
        for done in range(0, steps, LAP):
            timed = _numpy(scene) if name == "numpy" else CompiledModel(scene, threads=count).step
            timed(WARM)
            cpu, wall = cpu - process_time(), wall - perf_counter()
            taken.append(timed(min(LAP, steps - done)))
            cpu, wall = cpu + process_time(), wall + perf_counter()
        times = np.concatenate(taken) / 1000
        clock = _python_clock() if name == "numpy" else _compiled_clock()
        figures[name] = {
            "threads": count,
            "steps": steps,
            "step_us": float(np.median(times)),
            "p999_us": float(np.percentile(times, 99.9)),
            "max_us": float(times.max()),
            "clock_us": float(np.median(clock)) / 1000,
            "running": min(1.0, cpu / (wall * count)),
        }
    return figures


def _numpy(scene: Scene):
    model = Model(scene)
    return lambda steps: _timed(model.step, steps)


def _timed(call: Callable[[], object], times: int) -> np.ndarray:
    """Return (times,) in ns, the time of each call."""
    taken = np.empty(times, np.int64)
    for n in range(times):
        began = perf_counter_ns()
        call()
        taken[n] = perf_counter_ns() - began
    return taken


def _python_clock() -> np.ndarray:
    return _timed(lambda: None, 1000)


def _compiled_clock() -> np.ndarray:
    stamps = np.zeros((1001, 2), np.int64)
    idle(stamps)
    return np.diff(stamps @ [10**9, 1])
