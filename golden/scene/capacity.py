"""Capacities of the boards' circuits, read from the boards' files."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from golden.datapath.formats import Formats
from golden.mesh.mesh import Mesh
from golden.support.errors import InputError
from golden.support.paths import BOARDS


@dataclass(frozen=True)
class Capacity:
    """Nodes and edges that one board's circuit holds."""

    board: str
    nodes: int
    edges: int

    def shortfall(self, mesh: Mesh) -> str:
        """Return in words what the mesh has too many of, "" when it fits."""
        too_many = [
            f"{have} {what} of {room}"
            for what, have, room in (("nodes", len(mesh.points), self.nodes), ("edges", len(mesh.edges), self.edges))
            if have > room
        ]
        return ", ".join(too_many)


def load_capacities(folder: Path = BOARDS) -> list[Capacity]:
    """Return every board's capacity, by name. Raises `InputError` for a file without the two numbers."""
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


def max_edges_at_node(formats: Formats) -> int:
    """Return how many edges may meet at a node without the circuit's sum of their forces overflowing."""
    return formats.accumulator.raw_max // -formats.force.raw_min
