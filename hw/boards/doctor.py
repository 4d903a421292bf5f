"""``python -m hw doctor``: the programs and packages that are needed, and how to install those that are missing."""

import json
import os
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from msgspec import Struct, to_builtins

from hw.boards import flash
from hw.boards.project import project
from hw.boards.tools import YOSYS
from hw.families.registry import family_names, get_family

REINSTALL = "remove .venv and run `make environment`"


class Finding(Struct):
    """One thing that was looked for."""

    what: str
    state: str  # its version, or what is wrong with it
    fine: bool
    needed: bool  # by targets of make that need no board
    do: str = ""  # the remedy, if it isn't fine


def add_options(command) -> None:
    command.add_argument("--json", action="store_true", help="for a program to read")


def run(args) -> int:
    """Return the exit code: 0 if everything is there that make needs, 1 otherwise."""
    findings = [*system(), *packages(), *programs(), loader(), *ports()]
    lacking = sum(finding.needed and not finding.fine for finding in findings)
    if args.json:
        print(json.dumps({"fine": not lacking, "findings": to_builtins(findings)}, indent=1))
    else:
        show(findings)
        print(f"{lacking} things are missing that make needs" if lacking else "everything is there that make needs")
    return 1 if lacking else 0


def system() -> Iterator[Finding]:
    """Python, and the programs and libraries that pip can't install."""
    import environment  # a script of the checkout, which no other command needs

    yield _finding("Python", environment.VERSION, "")  # environment.py refuses an old one
    for what, package, there in environment.checked():
        yield _finding(what, "there" if there else None, environment.install_it(package))
    for what, package, there in environment.browser():
        do = f"for the tests of the report: {environment.install_it(package)}"
        yield _finding(what, "there" if there else None, do, needed=False)


def packages() -> Iterator[Finding]:
    """The direct dependencies."""
    for pin in project()["dependencies"]:
        name, wanted = pin.split("==")
        there = _version(name)
        if there in (None, wanted):
            yield _finding(f"Python package {name}", there, REINSTALL)
        else:
            yield Finding(f"Python package {name}", f"{there} instead of {wanted}", False, True, REINSTALL)


def programs() -> Iterator[Finding]:
    """The programs for synthesis, place and route and packing, which pip installs."""
    folder = Path(sys.executable).parent
    wanted = {YOSYS: YOSYS}
    for name in family_names():
        if flow := get_family(name).flow:
            wanted |= flow.programs
    for program, package in wanted.items():
        yield _finding(f"program {program}", _version(package) if (folder / program).exists() else None, REINSTALL)


def loader() -> Finding:
    """The program that loads a bitstream."""
    found = flash.find_loader()
    return _finding("openFPGALoader", found and found[1], f"for `make flash`: {flash.INSTALL}", needed=False)


def ports() -> Iterator[Finding]:
    """The serial ports, and whether the user may open them."""
    try:
        from serial.tools import list_ports
    except ImportError:  # `packages` says so
        return
    found = sorted(list_ports.comports(), key=lambda port: port.device)
    if not found:
        yield _finding("serial port", None, "to run on a board: connect it", needed=False)
    for port in found:
        usable = os.access(port.device, os.R_OK | os.W_OK)
        state = port.description if usable else f"{port.description}, you may not read and write it"
        do = "" if usable else f"join its group: sudo usermod -aG {_group(port.device)} $USER, and log in again"
        yield Finding(f"serial port {port.device}", state, usable, False, do)


def _group(device: str) -> str:
    try:
        return Path(device).group()
    except (OSError, KeyError):
        return "dialout"  # Debian's name


def _version(package: str) -> str | None:
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def _finding(what: str, state: str | None, do: str, *, needed: bool = True) -> Finding:
    return Finding(what, state or "missing", state is not None, needed, "" if state else do)


def show(findings: list[Finding]) -> None:
    """Print a table on a terminal, else a line for each finding."""
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
