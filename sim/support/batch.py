"""Work on many scenes, each in a process of its own, as many at a time as there are cores."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from functools import partial
from multiprocessing import active_children, get_context

from golden.physics.scene import Scene

POLL = 0.2  # s between two looks for progress


def over_scenes(work: Callable, scenes: list[Scene], report_progress: Callable | None = None) -> list:
    """Return ``[work(scene, progress), ...]``. ``work`` must be importable from the processes, and so what it returns.

    With ``report_progress``, every ``progress(stage, steps done)`` of a scene arrives here as
    ``report_progress(number, stage, steps done)``; without, ``progress`` is None. The first exception ends it all.
    """
    workers = min(len(scenes), cores())
    if workers == 1:
        return [work(scene, report_progress and partial(report_progress, n)) for n, scene in enumerate(scenes)]

    context = get_context("spawn")
    queue = context.SimpleQueue()
    with ProcessPoolExecutor(workers, context, _start, (queue if report_progress else None,)) as pool:
        # the longest first: started last, it would keep one core busy alone
        order = sorted(range(len(scenes)), key=lambda n: -scenes[n].steps * len(scenes[n].mesh.edges))
        futures = {n: pool.submit(_call, work, scenes[n], n) for n in order}
        waiting = set(futures.values())
        try:
            while waiting:
                finished, waiting = wait(waiting, POLL, FIRST_COMPLETED)
                while not queue.empty():
                    report_progress(*queue.get())
                for future in finished:
                    future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for child in active_children():
                child.terminate()
            raise
    return [futures[n].result() for n in range(len(scenes))]


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0))


def _start(queue) -> None:
    global _queue
    _queue = queue
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent gets it and ends this process


def _call(work, scene: Scene, number: int):
    return work(scene, _queue and partial(_send, number))


def _send(number: int, stage: str, steps: int) -> None:
    _queue.put((number, stage, steps))
