"""``python -m hw map``: the memory map and the link, for drivers in other languages."""

from pathlib import Path

from hw import options
from hw.emit import build, pages

OUT = "build/map"


def add_options(command) -> None:
    options.add_circuit(command)
    command.add_argument("--out", default=OUT, metavar="DIR", help=f"folder to write to ({OUT})")


def run(args) -> int:
    chosen, folder = options.parameters(args), Path(args.out)
    pages.write(chosen, folder)
    print(f"{folder}: map of {build.describe(chosen)}")
    return 0
