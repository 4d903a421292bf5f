"""Many scenes, each in a process of its own, as many at a time as there are cores."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from functools import partial
from multiprocessing import active_children, get_context

from golden.physics.scene import Scene

POLL = 0.2  # s between two looks for progress


def over_scenes(work: Callable, scenes: list[Scene], shown: Callable | None = None) -> list:
    """``[work(scene, progress), ...]``. `work` must be importable from the processes, and so what it returns.

    With ``shown``, every ``progress(backend, steps done)`` of a scene arrives here as ``shown(number, backend,
    steps done)``; without, ``progress`` is None. The first exception ends it all.
    """
    workers = min(len(scenes), cores())
    if workers == 1:
        return [work(scene, shown and partial(shown, n)) for n, scene in enumerate(scenes)]

    context = get_context("spawn")
    queue = context.SimpleQueue()
    with ProcessPoolExecutor(workers, context, _start, (queue if shown else None,)) as pool:
        # the longest first, so that no core is left with it in the end
        order = sorted(range(len(scenes)), key=lambda n: -scenes[n].steps * len(scenes[n].mesh.edges))
        futures = {n: pool.submit(_call, work, scenes[n], n) for n in order}
        waiting = set(futures.values())
        try:
            while waiting:
                finished, waiting = wait(waiting, POLL, FIRST_COMPLETED)
                while not queue.empty():
                    shown(*queue.get())
                for future in finished:
                    future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for child in active_children():
                child.terminate()
            raise
    return [futures[n].result() for n in range(len(scenes))]


def cores() -> int:
    return len(os.sched_getaffinity(0))


def _start(queue) -> None:
    global _queue
    _queue = queue
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent hears it and ends this process


def _call(work, scene: Scene, number: int):
    return work(scene, _queue and partial(_send, number))


def _send(number: int, backend: str, steps: int) -> None:
    _queue.put((number, backend, steps))
