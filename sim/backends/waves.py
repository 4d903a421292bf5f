"""Whether waveforms can be recorded on this machine."""

from __future__ import annotations

import subprocess
from pathlib import Path

from golden.support.errors import InputError

FORMATS = "vcd", "fst"
HEADERS = {"vcd": {}, "fst": {"zlib.h": "zlib1g-dev", "lz4.h": "liblz4-dev"}}
"""What a format's writer includes, and Debian's package that has it."""


def check(path: Path) -> None:
    """Raise `InputError` for a format that isn't known or that the C++ compiler lacks a library for."""
    form = path.suffix[1:]
    if form not in FORMATS:
        raise InputError(f"waves must be a file ending in {' or '.join(f'.{f}' for f in FORMATS)}, not {path.name}")
    lacking = [package for header, package in HEADERS[form].items() if not found(header)]
    if lacking:
        raise InputError(
            f"waves as {form} need a library that is missing: install it (Debian: apt install "
            f"{' '.join(lacking)}), or take vcd, which needs none"
        )


def found(header: str) -> bool:
    """Whether the C++ compiler finds a header. A missing compiler is reported by who compiles."""
    try:
        return not subprocess.run(
            ["c++", "-E", "-x", "c++", "-include", header, "/dev/null"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            check=False,
        ).returncode
    except FileNotFoundError:
        return True
