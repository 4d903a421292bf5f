"""A progress bar on stderr, where that is a terminal."""

import sys
from contextlib import contextmanager


@contextmanager
def progress(steps: int):
    """Yield a function to call with the name of each step as it begins; it does nothing without a terminal."""
    if not sys.stderr.isatty():
        yield lambda step: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = TextColumn("{task.description:9}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn()
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task("", total=steps, completed=-1)

        def begin(step: str) -> None:
            bars.update(task, description=step, advance=1)

        yield begin
