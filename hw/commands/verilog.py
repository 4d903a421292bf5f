"""``python -m hw verilog``: the Verilog and its manifest."""

from pathlib import Path

from golden.support.command import status_line
from hw import options
from hw.emit import build

OUT = "build/verilog"


def add_options(command) -> None:
    options.add_circuit(command)
    command.add_argument("--out", default=OUT, metavar="DIR", help=f"folder to write to ({OUT})")
    command.add_argument("--force", action="store_true", help="replace another tool's files of the same names")


def run(args) -> int:
    chosen, folder = options.parameters(args), Path(args.out)
    with status_line(f"writing the Verilog of {build.describe(chosen)} ..."):
        new = build.build(chosen, folder, force=args.force)
    print(f"{folder / build.VERILOG}: {build.describe(chosen)}{'' if new else ' (up to date)'}")
    return 0
