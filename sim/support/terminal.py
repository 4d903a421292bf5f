"""What a comparison shows on the terminal: progress while it runs, then one table."""

from __future__ import annotations

import sys
from contextlib import contextmanager

from golden.physics.scene import Scene
from sim.results.compare import power, shortcomings
from sim.run import COMPARED


@contextmanager
def bars(totals: list[tuple[str, int]]):
    """Bars on stderr, one for each (name, total); gives ``shown(number, done, doing)``, or None where stderr is not a
    terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = [TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[doing]:5}"), TimeElapsedColumn()]
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        tasks = [progress.add_task(name, total=total, start=False, doing="") for name, total in totals]

        def shown(number: int, done: int, doing: str = "") -> None:
            progress.start_task(tasks[number])
            progress.update(tasks[number], completed=done, doing=doing)

        yield shown


@contextmanager
def progress(scenes: list[Scene], backends=COMPARED):
    """Bars on stderr; gives ``shown(number, backend, steps done)``, or None where stderr is not a terminal."""
    with bars([(scene.name, len(backends) * scene.steps) for scene in scenes]) as shown:
        yield shown and (
            lambda number, backend, steps: shown(
                number, backends.index(backend) * scenes[number].steps + steps, backend
            )
        )


@contextmanager
def steps(scene: Scene, backend: str):
    """A bar on stderr for one run; gives ``shown(steps done)``, or None where stderr is not a terminal."""
    with progress([scene], (backend,)) as shown:
        yield shown and (lambda done: shown(0, backend, done))


def shown(what: str):
    """A function that gives the items of a sequence one by one, with a bar on stderr where that is a terminal."""
    if not sys.stderr.isatty():
        return iter
    from rich.console import Console
    from rich.progress import track

    return lambda items: track(items, what, console=Console(stderr=True), transient=True)


HEAD = "scene", "dim", "nodes", "edges", "steps", "rtl=fixed", "max dx", "allowed", "max da", "saturated", "s", ""


def print_table(entries: list[dict]) -> None:
    """One line a scene, on stdout, below 100 columns unless a scene has a very long name."""
    rows = [HEAD]
    for e in entries:
        rows.append(
            (
                e["scene"],
                *(str(e[key]) for key in ("dim", "nodes", "edges", "steps")),
                {True: "yes", False: "NO", None: "-"}[e["rtl_equals_fixed"]],
                power(e["max_dx_rel"]),
                power(e["bound"]),
                power(e["max_da"]),
                str(e["saturations"]),
                f"{e['seconds']:.0f}",
                "FAILS" if shortcomings(e) else "passes",
            )
        )
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lanes = sorted({e["lanes"] for e in entries if e["lanes"]})
    with_lanes = f"circuit with {' or '.join(map(str, lanes))} lane{'s' * (lanes != [1])}" if lanes else "circuit"
    print(
        f"{with_lanes} against integer model (rtl=fixed: every bit of every frame), integer model\n"
        "against float64 (max dx: largest position difference / size of the object; max da: of a ratio)\n"
    )
    for row in rows:
        print("  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]).rstrip())
