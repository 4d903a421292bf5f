"""``python -m sim compare``: scenes on all backends that are compared, side by side."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from functools import partial

from golden.scene import load as scenes
from golden.support.errors import InputError
from sim.backends import rtl
from sim.commands.common import add_json, add_out
from sim.commands.report import write
from sim.support.errors import about

HELP = "run scenes on all backends side by side and report the differences"


def add_options(command: ArgumentParser) -> None:
    """Add the command's options."""
    command.add_argument("scenes", nargs="+", metavar="SCENE", help="scene files (TOML)")
    for size in rtl.SIZE_OPTIONS:
        size.add_to(command)
    add_out(command, "build/report", "folder for compare.json and index.html")
    add_json(command, "compare.json instead of a table")


def run(args: Namespace) -> int:
    """Compare the scenes; return 1 if one of them does not pass."""
    from sim import report
    from sim.backends.registry import compared_backends
    from sim.compare import RANGES
    from sim.encode import limits
    from sim.support import batch, folder, terminal

    circuit = rtl.RtlBackend(args.lanes or rtl.LANES, args.updates or rtl.UPDATES)
    circuit.check()
    loaded = [scenes.load(path) for path in args.scenes]
    names = [scene.name for scene in loaded]
    if twice := {name for name in names if names.count(name) > 1}:
        raise InputError(f"scenes must have names of their own, not {min(twice)!r} twice")
    for scene in loaded:
        with about(scene):
            circuit.check_room(limits.encode_checked(scene))
    out = folder.claim(args.out, args.force)
    work = partial(report.section, lanes=circuit.lanes, updates=circuit.updates)
    with terminal.scene_bars(loaded, (*compared_backends(), RANGES)) as report_progress:
        sections = batch.over_scenes(work, loaded, report_progress)
    return write(args, sections, out)
