"""The sizes of a circuit, in one table.

Parameters, options, boards' files and tables, manifest, the link's identity and the control registers follow from here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from golden.datapath import records
from golden.numbers.graph import AXES

if TYPE_CHECKING:
    from hw.parameters import Parameters

EDGE, NODE = records.edge_entry(), records.node_entry()


class Constant(NamedTuple):
    """A control register with a constant of the circuit, for the host."""

    name: str
    meaning: str
    value: Callable[[Parameters], int]


@dataclass(frozen=True)
class Size:
    """One size of a circuit.

    Attributes
    ----------
    name : str
        Name in options and files, a plural for a count.
    meaning : str
        For help, manifest and documentation.
    default : int
    small : int
        Its value in the smallest circuit, which is placed in minutes.
    allowed : range or tuple of int
        A range without steps, or a few values.
    letter : str
        Placeholder of the value in the help text.
    held : Constant
        The control register, if it holds something else than the size itself.
    optional : bool
        Whether a board's file may leave it out; it then has the default.
    column : bool
        Whether tables of boards show it.
    brief : bool
        Whether the README's short table shows it too.
    """

    name: str
    meaning: str
    default: int
    small: int
    allowed: range | tuple[int, ...]
    letter: str
    held: Constant | None = None
    optional: bool = False
    column: bool = False
    brief: bool = False

    @property
    def choice(self) -> str:
        """The allowed values, for help."""
        if len(self.allowed) > 2:
            return f"{self.allowed[0]} to {self.allowed[-1]}"
        return " or ".join(map(str, self.allowed))

    @property
    def constant(self) -> Constant:
        """The control register that tells a host this size."""
        return self.held or Constant(self.name.upper(), self.meaning, lambda p: sizes_of(p)[self.name])

    def check(self, value) -> None:
        """Raise ValueError unless the value is allowed."""
        if not isinstance(value, int) or value not in self.allowed:
            kind = "a whole number from " if len(self.allowed) > 2 else ""
            raise ValueError(f"{self.name} must be {kind}{self.choice}, not {value!r}")


def _upto(most: int, least: int = 1) -> range:
    return range(least, most + 1)


SIZES: dict[str, Size] = {
    size.name: size
    for size in (
        Size("lanes", "edge processors", 4, 1, _upto(NODE["mask"].width // 2), "P", column=True, brief=True),
        Size("updates", "nodes updated per cycle", 1, 1, _upto(2), "M", column=True),
        Size("nodes", "capacity: nodes", 512, 16, _upto(EDGE["i"].raw_max + 1, least=2), "N", column=True, brief=True),
        Size(
            "edges",
            "capacity: edges",
            4096,
            16,
            _upto(1 << 16),  # index bits of a host address
            "E",
            held=Constant("ROWS", "capacity: edges of each lane", lambda p: p.rows),
            column=True,
            brief=True,
        ),
        Size("materials", "capacity: materials", 16, 2, _upto(EDGE["material"].raw_max + 1), "M"),
        Size("tables", "capacity: damper tables", 4, 1, _upto(16), "T"),
        Size(
            "axes",
            "axes of a node that an updater takes per cycle",
            len(AXES),
            len(AXES),
            (1, len(AXES)),
            "A",
            optional=True,
        ),
    )
}

WORDS = {
    "operand": "bits of a multiplier's operand",
    "state": "bits of a stored state",
}
"""Word lengths: the parameters of `golden.datapath.formats.Formats`, which checks them."""


def sizes_of(holder) -> dict[str, int]:
    """Return the sizes of `hw.parameters.Parameters`, or of anything else with such attributes."""
    return {name: getattr(holder, name) for name in SIZES}


def words_of(holder) -> dict[str, int]:
    """Return the word lengths of `golden.datapath.formats.Formats` or anything with such attributes."""
    return {"operand": holder.operand, "state": holder.state}


def cycles_per_node(holder) -> int:
    """Return the cycles that an updater takes for a node."""
    return len(AXES) // holder.axes


def format_sizes(holder) -> dict[str, str]:
    """Return the sizes as text. The axes appear in the updates per cycle, as in 1/3."""
    texts = {name: str(size) for name, size in sizes_of(holder).items() if name != "axes"}
    if (cycles := cycles_per_node(holder)) > 1:
        texts["updates"] += f"/{cycles}"
    return texts


def summary(holder) -> str:
    """Return all sizes in words, for a sentence."""
    return ", ".join(f"{n} {name.removesuffix('s') if n == '1' else name}" for name, n in format_sizes(holder).items())
