"""The compiled float model: `golden.physics.model.Model` with linear dampers, as fast as Numba makes it."""

from __future__ import annotations

import os
from threading import Thread

import numpy as np

from golden.physics.scene import Phase, Scene
from golden.support.errors import InputError
from sim.speed import arrays
from sim.speed.kernel import run


class CompiledModel:
    """An object in motion, as `golden.physics.model.Model`: it starts at rest, under the scene's first phase.

    Parameters
    ----------
    dtype
        The type of all its numbers.
    threads
        The number of threads that share a step; each keeps a core busy.

    Raises
    ------
    InputError
        If a damper depends on the force, or ``threads`` is below 1.
    """

    def __init__(self, scene: Scene, dtype=np.float32, threads: int = 1):
        if type(threads) is not int or threads < 1:
            raise InputError(f"threads must be a whole number of at least 1, not {threads!r}")
        self._scene, self._threads = scene, threads
        self._arrays = arrays.arrays(scene, dtype)
        counts = len(scene.mesh.edges), len(scene.mesh.points)
        self._shares = [arrays.shares(count, threads) for count in counts]
        self.begin(scene.phases[0])

    def begin(self, phase: Phase) -> None:
        """Put the object under a phase's constraints and loads."""
        arrays.begin(self._arrays, self._scene, phase)

    def step(self, steps: int = 1) -> np.ndarray:
        """Run so many steps and return (steps,) in ns, the time that each of them took."""
        counter, stamps = arrays.rows([[0]], np.int64)[0], np.zeros((steps + 1, 2), np.int64)

        cores = sorted(os.sched_getaffinity(0))

        def part(thread):
            if self._threads > 1:  # two on one core would take turns at every barrier, and the system lets them
                os.sched_setaffinity(0, {cores[thread % len(cores)]})
            run(self._arrays, *self._shares, thread, self._threads, counter, steps, stamps)

        # daemons, because they may wait for this thread when an interrupt ends the program
        others = [Thread(target=part, args=(thread,), daemon=True) for thread in range(1, self._threads)]
        for other in others:
            other.start()
        try:
            part(0)
        finally:
            os.sched_setaffinity(0, cores)
        for other in others:
            other.join()
        return np.diff(stamps @ [10**9, 1])

    @property
    def x(self) -> np.ndarray:
        """Positions (N, dim) in m."""
        return self._arrays.node[: self._scene.dim, : len(self._scene.mass)].T

    @property
    def v(self) -> np.ndarray:
        """Velocities (N, dim) in m/s."""
        return self._arrays.node[self._scene.dim :, : len(self._scene.mass)].T

    @property
    def a(self) -> np.ndarray:
        """Ratios (E,)."""
        return self._arrays.edge[arrays.RATIO, : len(self._arrays.i)]
