"""``python -m sim run``: one scene on one backend."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from pathlib import Path

from golden.scene import load as scenes
from golden.support.errors import InputError
from sim.backends import waves
from sim.backends.backend import Backend, Option
from sim.backends.registry import BACKENDS
from sim.commands.common import add_json, add_out, print_json
from sim.support.errors import about

HELP = "run one scene on one backend"


def add_options(command: ArgumentParser) -> None:
    """Add the command's own options and those of all backends."""
    command.add_argument("scene", metavar="SCENE", help="a scene file (TOML)")
    summaries = "; ".join(f"{name}: {backend.summary}" for name, backend in BACKENDS.items())
    command.add_argument("--backend", required=True, choices=tuple(BACKENDS), help=summaries)
    for option, owners in _options().values():
        option.add_to(command, f"{' or '.join(owners)}: ")
    add_out(command, None, "folder for scene.npz, trajectory.npz and summary.json")
    add_json(command, "summary.json instead of a line")


def _options() -> dict[str, tuple[Option, list[str]]]:
    """Return the options of all backends by name, each with the backends that it belongs to."""
    found: dict[str, tuple[Option, list[str]]] = {}
    for name, backend in BACKENDS.items():
        for option in backend.options:
            found.setdefault(option.name, (option, []))[1].append(name)
    return found


def chosen(args: Namespace, out: Path) -> Backend:
    """Return the backend that the options ask for. Raises `InputError` for values that can't
    be used, and for options of another backend."""
    for name, (_, owners) in _options().items():
        if vars(args)[name] and args.backend not in owners:
            raise InputError(f"--{name} must go with --backend {' or '.join(owners)}, not {args.backend}")
    backend = BACKENDS[args.backend].from_options(args, out)
    backend.check()
    return backend


def run(args: Namespace) -> int:
    """Run the scene and keep the run; return 1 if something saturated."""
    from sim.results import run_folder
    from sim.run import run
    from sim.support import folder, terminal

    backend = chosen(args, Path(args.out))
    scene = scenes.load(args.scene)
    out = folder.claim(args.out, args.force)
    for suffix in waves.FORMATS:  # of an earlier run
        (out / f"waves.{suffix}").unlink(missing_ok=True)
    backend = backend.connect()
    with about(scene), terminal.run_bar(scene, backend.name) as report_progress:
        result = run(scene, backend, progress=report_progress)
    run_folder.save(scene, result, out)
    if not print_json(args, out / run_folder.SUMMARY):
        print(
            f"{scene.name}: {scene.steps} steps on {backend.name} in {result.seconds:.1f} s, "
            f"{len(scene.frames)} frames in {out / run_folder.TRAJECTORY}"
        )
    if result.faults:
        print(f"error: saturated: {', '.join(result.faults)}", file=sys.stderr)
    return 1 if result.faults else 0
