"""The benchmark on the terminal: its progress, and two tables in the end."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from pathlib import Path

from sim.speed.timing import SOFTWARE

IDLE = 0.95  # part of the time that a program must have run for its figures to be meaningful
SHORT = {"numpy": "NumPy", "numba_1_thread": "Numba-1", "numba_all_threads": "Numba-all"}


@contextmanager
def progress():
    """Give ``report_progress(text)``: it writes a line on stderr that replaces the one before, if stderr is a terminal.

    Nothing moves by itself: a bar drawn while a step is timed would take the core that the step needs.
    """
    if not sys.stderr.isatty():
        yield lambda text: None
        return
    try:
        yield lambda text: print(f"\r\x1b[K{text} ...", end="", file=sys.stderr, flush=True)
    finally:
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)


def print_tables(entries: list[dict]) -> None:
    """Print the circuits' steps and how many times longer the programs take, then the programs' own times."""
    software = entries[0]["software"]
    print(
        "One step evaluates every edge 4 times, as Runge-Kutta wants it. Circuit with P lanes and M node updates a "
        f"cycle,\nat {entries[0]['clock_mhz']:g} MHz. Software on this machine: median step in us, and how many "
        f"times the circuit's it is.\nProcessor: {processor()}\n"
    )
    rows = [
        [
            "mesh",
            "nodes",
            "edges",
            "P",
            "M",
            "cycles",
            "busy",
            "us",
            "M edges/s",
            *(title for name in software for title in (SHORT[name], "times")),
        ]
    ]
    for e in entries:
        rows.append(
            [
                e["mesh"],
                *(str(e[key]) for key in ("nodes", "edges", "lanes", "updates", "cycles_per_step")),
                f"{e['occupancy']:.3f}",
                f"{e['step_us']:.2f}",
                f"{e['edge_evals_per_s'] / 1e6:.1f}",
                *(
                    text
                    for program in e["software"].values()
                    for text in (f"{program['step_us']:.1f}", f"{program['ratio']:.2f}")
                ),
            ]
        )
    _print(rows)

    print("\nStep times of the software in us (the circuit's are all the same):\n")
    rows = [["mesh", *(title for name in software for title in (SHORT[name], "99.9 %", "longest"))]]
    for e in {e["mesh"]: e for e in entries}.values():
        rows.append(
            [
                e["mesh"],
                *(
                    f"{program[key]:.1f}"
                    for program in e["software"].values()
                    for key in ("step_us", "p999_us", "max_us")
                ),
            ]
        )
    _print(rows)
    print()
    for name, program in software.items():
        print(
            f"{SHORT[name]}: {SOFTWARE[name]}; threads: {program['threads']}, steps: {program['steps']}, "
            f"looking at the clock: {program['clock_us']:.2f} us"
        )
    if busy := disturbed(entries):
        print(f"\nwarning: other programs used the machine, the software's times are too long: {', '.join(busy)}")


def disturbed(entries: list[dict]) -> list[str]:
    """Return the programs that did not have the cores to themselves, with the part of the time that they had."""
    least = {name: min(e["software"][name]["running"] for e in entries) for name in entries[0]["software"]}
    return [f"{SHORT[name]} had {part:.0%} of its cores" for name, part in least.items() if part < IDLE]


def _print(rows: list[list[str]]) -> None:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        print("  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])]).rstrip())


def processor() -> str:
    """Return the processor's name."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), "unknown processor")
