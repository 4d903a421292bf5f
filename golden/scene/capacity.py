"""How large an object the circuits of the boards hold, as the boards' files say: the data alone, not the circuit."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from golden.datapath.formats import Formats
from golden.mesh.mesh import Mesh
from golden.support.errors import InputError
from golden.support.paths import BOARDS

FOLDER = BOARDS


@dataclass(frozen=True)
class Capacity:
    """What one board's circuit has room for."""

    board: str
    nodes: int
    edges: int

    def lacks(self, mesh: Mesh) -> str:
        """What of the mesh is too much for it, in words; nothing when it fits."""
        too_many = [
            f"{have} {what} of {room}"
            for what, have, room in (("nodes", len(mesh.points), self.nodes), ("edges", len(mesh.edges), self.edges))
            if have > room
        ]
        return ", ".join(too_many)


def boards(folder: Path = FOLDER) -> list[Capacity]:
    """Every board's, in the order of their names. Raises `InputError` for a file without the two numbers."""
    found = []
    for path in sorted(folder.glob("*.toml")):
        try:
            sizes = tomllib.loads(path.read_text(encoding="utf-8"))["circuit"]
            found.append(Capacity(path.stem, int(sizes["nodes"]), int(sizes["edges"])))
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(
                f"{path}: circuit.nodes and circuit.edges must be whole numbers in a TOML file ({error})"
            ) from None
    return found


def most_at_a_node(formats: Formats) -> int:
    """Edges that may meet at a node: the circuit's sum of so many forces cannot overflow."""
    return formats.accumulator.raw_max // -formats.force.raw_min
