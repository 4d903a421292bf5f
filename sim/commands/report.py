"""``python -m sim report``: the page of existing runs."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from functools import partial
from pathlib import Path

from sim.backends.float64 import FloatBackend
from sim.commands.common import add_json, add_out, print_json

HELP = "write the page of existing runs"


def add_options(command: ArgumentParser) -> None:
    """Add the command's options."""
    command.add_argument(
        "runs",
        nargs="+",
        metavar="RUN",
        help="folders of `run`: those of the same scene go together; float64, if it isn't there, is run",
    )
    add_out(command, "build/report", "folder for compare.json and index.html")
    add_json(command, "compare.json instead of a table")


def run(args: Namespace) -> int:
    """Write the page of the runs; return 1 if a scene does not pass."""
    from sim import report
    from sim.compare import RANGES
    from sim.results.run_groups import group_by_scene
    from sim.support import batch, folder, terminal

    groups = group_by_scene(args.runs)
    out = folder.claim(args.out, args.force)
    loaded, folders = [scene for scene, _ in groups], {scene.name: runs for scene, runs in groups}
    with terminal.scene_bars(loaded, (FloatBackend.name, RANGES)) as report_progress:
        sections = batch.over_scenes(partial(report.of_runs, folders=folders), loaded, report_progress)
    return write(args, sections, out)


def write(args: Namespace, sections: list, out: Path) -> int:
    """Write the page and print its table; return 1 if a scene does not pass, and say why."""
    from sim import report
    from sim.results.comparison import shortcomings
    from sim.results.table import print_table

    entries = [section.entry for section in sections]
    report.write(sections, out)
    if not print_json(args, out / report.DATA):
        print_table(entries)
    wrong = [(entry["scene"], reason) for entry in entries for reason in shortcomings(entry)]
    for name, reason in wrong:
        print(f"error: {name}: {reason}", file=sys.stderr)
    return 1 if wrong else 0
