"""``python -m sim export``: a run in a form that other programs read."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from sim.commands.common import add_force

HELP = "write a run in a form that other programs read"


def add_options(command: ArgumentParser) -> None:
    """Add the command's options."""
    command.add_argument("run_folder", metavar="RUN", help="folder that `run` left")
    command.add_argument(
        "--vtu", action="store_true", required=True, help="for ParaView: run.pvd and a file for each frame"
    )
    command.add_argument("--out", metavar="DIR", help="folder to write to (RUN/vtu)")
    add_force(command)


def run(args: Namespace) -> int:
    """Export the run."""
    from sim.results import export, run_folder
    from sim.support import folder, terminal

    scene, _, trajectory = run_folder.load(args.run_folder)
    out = folder.claim(args.out or Path(args.run_folder) / "vtu", args.force)
    *frames, collection = export.vtu(scene, trajectory, out, terminal.tracker("frames"))
    print(f"{scene.name}: {len(frames)} frames in {collection}")
    return 0
