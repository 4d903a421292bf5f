"""Progress on the terminal: bars on stderr where that is a terminal, nothing elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from golden.physics.scene import Scene


@contextmanager
def bars(totals: list[tuple[str, int]]) -> Iterator[Callable | None]:
    """Show a bar for each (name, total); gives ``report_progress(number, done, stage="")``, or None where stderr is
    not a terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = [TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[stage]:5}"), TimeElapsedColumn()]
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        tasks = [progress.add_task(name, total=total, start=False, stage="") for name, total in totals]

        def report_progress(number: int, done: int, stage: str = "") -> None:
            progress.start_task(tasks[number])
            progress.update(tasks[number], completed=done, stage=stage)

        yield report_progress


@contextmanager
def scene_bars(scenes: list[Scene], stages: tuple[str, ...]) -> Iterator[Callable | None]:
    """Show a bar for each scene, which goes through the stages; gives ``report_progress(number, stage, steps done)``,
    or None where stderr is not a terminal."""
    with bars([(scene.name, len(stages) * scene.steps) for scene in scenes]) as report_progress:
        yield report_progress and (
            lambda number, stage, steps: report_progress(
                number, stages.index(stage) * scenes[number].steps + steps, stage
            )
        )


@contextmanager
def run_bar(scene: Scene, backend: str) -> Iterator[Callable | None]:
    """Show a bar for one run; gives ``report_progress(steps done)``, or None where stderr is not a terminal."""
    with scene_bars([scene], (backend,)) as report_progress:
        yield report_progress and (lambda steps: report_progress(0, backend, steps))


def tracker(what: str) -> Callable[[Iterable], Iterable]:
    """Return a function that gives the items of a sequence one by one and shows a bar meanwhile."""
    if not sys.stderr.isatty():
        return iter
    from rich.console import Console
    from rich.progress import track

    return lambda items: track(items, what, console=Console(stderr=True), transient=True)
