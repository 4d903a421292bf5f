"""``python -m sim bench``: the circuit's step beside that of software on this machine."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace
from pathlib import Path

from sim.commands.common import add_json, print_json
from sim.support.arguments import megahertz, whole

HELP = "time the circuit's step and that of software on this machine"


def add_options(command: ArgumentParser) -> None:
    """Add the command's options."""
    command.add_argument("--meshes", nargs="+", metavar="MESH", help="nodes along each axis, as 9x9 or 5x5x5")
    command.add_argument(
        "--steps", type=whole, default=10_000, metavar="N", help="steps of the software to time (10000)"
    )
    command.add_argument("--clock", type=megahertz, metavar="MHZ", help="the circuit's clock (timed: ULX3S-85F)")
    command.add_argument(
        "--out", default="build/bench.json", metavar="FILE", help="file for the figures (build/bench.json)"
    )
    add_json(command, "FILE instead of tables")


def run(args: Namespace) -> int:
    """Time the steps and print the tables."""
    from sim.results import cycles, step_time
    from sim.speed import bench, table, timing  # Numba is slow to load
    from sim.speed.meshes import MESHES

    out = bench.claim(Path(args.out))
    with table.progress() as report_progress:

        def software(scene):
            return timing.software(
                scene, args.steps, lambda name: report_progress(f"{scene.name}: {timing.SOFTWARE[name]}")
            )

        clock = args.clock or step_time.clock(bench.BOARD)
        entries = bench.bench(args.meshes or MESHES, cycles.cycles_per_step, software, clock=clock)
    bench.save(entries, out)
    if not print_json(args, out):
        table.print_tables(entries)
    return 0
