"""Formats of waveforms, and the check that this machine can record them."""

from __future__ import annotations

import subprocess
from pathlib import Path

from golden.support.errors import InputError

FORMATS = "vcd", "fst"
HEADERS = {"vcd": {}, "fst": {"zlib.h": "zlib1g-dev", "lz4.h": "liblz4-dev"}}
"""Headers that a format's writer includes, each with Debian's package of it."""


def check(path: Path) -> None:
    """Raise `InputError` for an unknown format, or one whose libraries the C++ compiler lacks."""
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
    """Return whether the C++ compiler finds a header; True without a compiler, which is reported when it is used."""
    try:
        return not subprocess.run(
            ["c++", "-E", "-x", "c++", "-include", header, "/dev/null"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            check=False,
        ).returncode
    except FileNotFoundError:
        return True
