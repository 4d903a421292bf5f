"""Compile a C++ program into a shared library, once for each source text and compiler."""

import hashlib
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from golden.support.errors import InputError
from golden.support.paths import BUILD

FOLDER = BUILD / "native"
FLAGS = "-std=c++17", "-O2", "-shared", "-fPIC", "-fwrapv"


def library(files: dict[str, str], main: str, folder: Path = FOLDER) -> Path:
    """Return the library of a program whose files are ``files``, by name, of which ``main`` is compiled.

    Processes may build the same library at the same time: each renames a finished file.

    Raises
    ------
    InputError
        If there is no C++ compiler.
    RuntimeError
        If the compiler refuses the program.
    """
    compiler = shutil.which("c++")
    if not compiler:
        raise InputError("the integer model needs a C++ compiler (c++): install one (Debian: apt install g++)")
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    key = hashlib.sha256(repr((sorted(files.items()), main, FLAGS, version)).encode()).hexdigest()[:16]
    built = folder / f"{Path(main).stem}-{key}.so"
    if not built.exists():
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as scratch:
            for name, text in files.items():
                Path(scratch, name).write_text(text)
            command = compiler, *FLAGS, "-o", "library.so", main
            done = subprocess.run(command, cwd=scratch, capture_output=True, text=True)
            if done.returncode:
                raise RuntimeError(f"{compiler} refuses {main}:\n{done.stderr}")
            os.replace(Path(scratch, "library.so"), built)
    return built
