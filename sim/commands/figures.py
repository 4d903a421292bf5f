"""``python -m sim figures``: the paper's figures from runs of the circuit."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace
from functools import partial

from sim.backends.fixed import FixedBackend
from sim.backends.float64 import FloatBackend
from sim.backends.registry import compared_backends, integer_backends
from sim.commands.common import add_json, add_out, print_json

HELP = "draw the paper's figures from runs of the circuit"


def add_options(command: ArgumentParser) -> None:
    """Add the command's options."""
    command.add_argument("names", nargs="*", metavar="NAME", help="figures, as figure-6 or gravity (all)")
    add_out(command, "build/figures", "folder for PNG, SVG and GIF of each, and figures.json")
    command.add_argument(
        "--backend",
        default=FixedBackend.name,
        choices=tuple(name for name in integer_backends() if name in compared_backends()),
        help=f"the circuit's integer model, or its Verilog under Verilator: the same bits ({FixedBackend.name})",
    )
    add_json(command, "figures.json instead of a table")


def run(args: Namespace) -> int:
    """Draw the figures; return 1 if one of them does not show what it must."""
    from sim.figures import catalogue, make, table
    from sim.support import folder, terminal

    names = catalogue.chosen(args.names)
    out = folder.claim(args.out, args.force)
    entries = make.earlier(out)
    loaded = make.scenes(names)
    with terminal.scene_bars(loaded, (FloatBackend.name, args.backend)) as report_progress:
        pairs = make.compute(loaded, args.backend, report_progress)
    with terminal.bars([(name, make.PICTURES) for name in names]) as report_progress:
        drawn = {
            name: make.draw(name, pairs, out, report_progress and partial(report_progress, number))
            for number, name in enumerate(names)
        }
    make.save(entries | drawn, out)
    if not print_json(args, out / make.DATA):
        table.print_readings(drawn)
        print(f"\nPNG, SVG and GIF of each figure are in {out}, the numbers in {out / make.DATA}")
    wrong = make.shortcomings(names, pairs)
    for reason in wrong:
        print(f"error: {reason}", file=sys.stderr)
    return 1 if wrong else 0
