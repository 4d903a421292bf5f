"""The control registers, a row each: the circuit, its driver, the manifest and the documentation read this table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

from hw.parameters import Parameters
from hw.sizes import SIZES

MAGIC = int.from_bytes(b"RHEO")
VERSION = 2


@dataclass(frozen=True)
class Row:
    """A control register.

    Attributes
    ----------
    name, meaning : str
    value : callable
        Its value in a circuit with such parameters, if it is a constant.
    counter : bool
        Counts something in a run.
    writable : bool
    least : int
    most : callable
        The least and the largest number that may be written; no limit without ``most``.
    while_busy : bool
        May be written while steps are run.
    """

    name: str
    meaning: str
    value: Callable[[Parameters], int] | None = None
    counter: bool = False
    writable: bool = False
    least: int = 0
    most: Callable[[Parameters], int] | None = None
    while_busy: bool = False


def _counter(name: str, meaning: str) -> Row:
    return Row(name, meaning, counter=True)


def _setting(name: str, meaning: str, *, least: int = 0, most: Callable[[Parameters], int]) -> Row:
    return Row(name, meaning, writable=True, least=least, most=most)


def _action(name: str, meaning: str) -> Row:
    """A register to which any word may be written at any time."""
    return Row(name, meaning, writable=True, while_busy=True)


ROWS = (
    Row("MAGIC", "`RHEO`", lambda p: MAGIC),
    Row("VERSION", "version of this map", lambda p: VERSION),
    *(Row(*size.constant) for size in SIZES.values()),
    Row("BUSY", "1 while steps are run"),
    _counter("CYCLES", "cycles of the last run"),
    _counter("ROWS_ISSUED", "cycles of the last run in which the lanes took a row of edges"),
    _counter("EDGES_ISSUED", "edges taken in the last run: a list's last row may lack some"),
    _counter("NODE_WAITS", "cycles of the last run in which a row waited for its nodes to be updated"),
    _counter("LIST_WAITS", "cycles of the last run in which the list of rows had not been read yet"),
    _counter("END_WAITS", "cycles of the last run after its last row; with rows issued and the other waits all cycles"),
    Row("STEPS_DONE", "steps of the last run that were done"),
    _action("FAULTS", "sticky, a bit for each name of the manifest; a 1 that is written clears it"),
    _action("REFUSED", "requests refused; any write clears it"),
    _setting("ROW_COUNT", "rows of edges in use, at least 1", least=1, most=lambda p: p.rows),
    _setting("NODE_COUNT", "nodes in use, at least 1", least=1, most=lambda p: p.nodes),
    _setting(
        "VELOCITY_SHIFT",
        "the velocity full scale is 2^-this sizes per step",
        most=lambda p: p.formats.exponent.raw_max,
    ),
    _setting("RUN", "a write runs so many steps, at least 1", least=1, most=lambda p: (1 << 32) - 1),
    _action("STOP", "any write ends the run with its step or the next; then `STEPS_DONE` says how many were done"),
)

Control = IntEnum("Control", [row.name for row in ROWS], start=0, module=__name__)
Control.__doc__ = "Index of a control register."

REGISTERS: dict[Control, Row] = dict(zip(Control, ROWS, strict=True))
COUNTERS = {control: row.name.lower() for control, row in REGISTERS.items() if row.counter}
"""The machine's counters, and the names of their ports."""


def constants(p: Parameters) -> dict[Control, int]:
    """The registers whose values don't change in a circuit."""
    return {control: row.value(p) for control, row in REGISTERS.items() if row.value}
