"""``python -m hw lint``: the Verilog, and Verilator's warnings about it."""

import sys
from pathlib import Path

from golden.support.paths import ROOT
from hw.commands import verilog
from hw.commands.verilog import add_options as add_options
from hw.emit.build import VERILOG
from hw.emit.lint import WAIVERS, lint
from hw.emit.verilog import TOP


def run(args) -> int:
    verilog.run(args)
    warnings = lint(Path(args.out) / VERILOG, top=TOP, family=args.family)
    for line in warnings:
        print(line, file=sys.stderr)
    print(f"{len(warnings)} warnings beyond those that {WAIVERS.relative_to(ROOT)} excuses")
    return 1 if warnings else 0
