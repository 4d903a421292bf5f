"""The command line: ``python -m hw verilog``, and lint, map, timing, bitstream, flash, doctor, docs."""

import argparse
import re
import sys
from pathlib import Path

from golden.datapath.formats import Formats
from golden.support.command import Parser, execute, said_meanwhile
from golden.support.errors import InputError
from golden.support.paths import ROOT
from hw.boards import doctor, flash
from hw.boards.bitstream import command as bitstream
from hw.boards.timing import command as timing
from hw.docs import command as docs
from hw.families import FAMILIES
from hw.parameters import Parameters

FORMATS = {
    "operand": "bits of a multiplier's operand",
    "state": "bits of a stored state",
}
LETTERS = {"lanes": "P", "updates": "M", "operand": "BITS", "state": "BITS"}
CAPACITIES = {
    "lanes": "edge processors",
    "updates": "nodes updated per cycle, 1 or 2",
    "nodes": "nodes it has room for",
    "edges": "edges it has room for",
    "materials": "materials it has room for",
    "tables": "tables of force-dependent dampers it has room for",
    "axes": "axes of a node updated per cycle, 3 or 1",
}


def parser() -> Parser:
    main = Parser(prog="python -m hw", description="The circuit's Verilog, and what is made of it.")
    names = "verilog|lint|map|timing|bitstream|flash|doctor|docs"
    commands = main.add_subparsers(dest="command", required=True, metavar=names)
    defaults = {**vars(Parameters()), **vars(Formats())}
    for name, run, what in (
        ("verilog", verilog, "write the Verilog and its manifest"),
        ("lint", lint, "write the Verilog and let Verilator judge it"),
        ("map", map_, "write the memory map and what is said over the link, as C header, page and JSON"),
    ):
        command = commands.add_parser(name, help=what)
        for option, meaning in {**CAPACITIES, **FORMATS}.items():
            command.add_argument(
                f"--{option}",
                type=whole,
                default=defaults[option],
                metavar=LETTERS.get(option, option[0].upper()),
                help=f"{meaning} ({defaults[option]})",
            )
        command.add_argument(
            "--family",
            default=defaults["family"],
            metavar="NAME",
            help=f"devices whose hard blocks it takes, {' or '.join(FAMILIES)} ({defaults['family']})",
        )
        out = "build/map" if name == "map" else "build/verilog"
        command.add_argument("--out", default=out, metavar="DIR", help=f"folder to write to ({out})")
        if name != "map":
            command.add_argument("--force", action="store_true", help="replace another tool's files of the same names")
        command.set_defaults(run=run)
    timing.add_options(commands.add_parser("timing", help="how fast and how large it is on a board"), whole)
    bitstream.add_options(commands.add_parser("bitstream", help="what is loaded into a board"), whole)
    flash.add_options(commands.add_parser("flash", help="load it"))
    doctor.add_options(commands.add_parser("doctor", help="what is there, what is missing, what to do about it"))
    docs.add_options(commands.add_parser("docs", help="bring the documents' tables and pictures up to date"))
    return main


def whole(text: str) -> int:
    if not re.fullmatch(r"-?[0-9]+", text):
        raise argparse.ArgumentTypeError(f"must be a whole number, not {text!r}")
    return int(text)


def parameters(args) -> Parameters:
    """What the options say. Raises `InputError` naming the option for a circuit that can't be."""
    try:
        formats = Formats(**{name: getattr(args, name) for name in FORMATS})
        capacities = {name: getattr(args, name) for name in CAPACITIES}
        return Parameters(**capacities, formats=formats, family=args.family)
    except ValueError as error:
        raise InputError(f"--{error}") from None


def verilog(args) -> int:
    from hw.emit import build

    chosen, folder = parameters(args), Path(args.out)
    with said_meanwhile(f"writing the Verilog of {build.describe(chosen)} ..."):
        new = build.build(chosen, folder, force=args.force)
    print(f"{folder / build.VERILOG}: {build.describe(chosen)}{'' if new else ' (up to date)'}")
    return 0


def lint(args) -> int:
    from hw.emit import build
    from hw.emit.lint import WAIVERS
    from hw.emit.lint import lint as warnings
    from hw.emit.verilog import TOP

    verilog(args)
    found = warnings(Path(args.out) / build.VERILOG, top=TOP, family=args.family)
    for line in found:
        print(line, file=sys.stderr)
    print(f"{len(found)} warnings beyond those that {WAIVERS.relative_to(ROOT)} excuses")
    return 1 if found else 0


def map_(args) -> int:
    from hw.emit import build, pages

    chosen, folder = parameters(args), Path(args.out)
    pages.write(chosen, folder)
    print(f"{folder}: map of {build.describe(chosen)}")
    return 0


def main(arguments=None) -> int:
    """Exit code: that of `golden.support.command.execute`, or 1 for warnings of the lint."""
    return execute(parser(), arguments)


if __name__ == "__main__":
    sys.exit(main())
