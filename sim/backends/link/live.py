"""Live access to nodes of an object on a board: read positions and forces, and write velocities, between two steps."""

from __future__ import annotations

import numpy as np

from golden.numbers.qformat import Q
from golden.support.errors import InputError
from hw.link.frame import Frame
from hw.link.items import Items
from hw.link.protocol import Kind
from hw.map.memory_map import NODE_FORCE, NODE_STATE, Map, Region
from sim.backends.link.board import Board
from sim.encode.encode import EncodedScene, raw_vectors
from sim.encode.order import ranks

AXES = 3
READ_ITEMS = 2 * AXES
"""Items of an answer for each node: position and force."""
ASKED_ITEMS, MOVED_ITEMS = 2, 1 + AXES
"""Items of a command for each node, and how many more if it sets the velocity."""


class Live:
    """Nodes of an object on a board, while it runs.

    Parameters
    ----------
    board : Board
        Loaded with ``encoded.image`` (`sim.backends.circuit.CircuitMachine`).
    encoded : sim.encode.encode.EncodedScene
    nodes : (n,) int
        In the scene's order.

    Raises
    ------
    InputError
        If there are more nodes than fit one exchange. Only values of one exchange are of the same step.
    """

    def __init__(self, board: Board, encoded: EncodedScene, nodes):
        self._board, self._encoded, self._nodes = board, encoded, np.asarray(nodes)
        self._ranks = ranks(encoded.node_order)[self._nodes]
        self._map = Map(board.parameters)
        self._items = Items.of_word(board.parameters.formats.state)
        most = most_nodes(self._items)
        if not 1 <= len(self._nodes) <= most:
            raise InputError(f"nodes must be 1 to {most}, which fit one exchange, not {len(self._nodes)}")

    def exchange(self, velocity=None) -> tuple[np.ndarray, np.ndarray]:
        """Read the nodes, and set their velocities, between two steps.

        Parameters
        ----------
        velocity : (n, dim) m/s, optional
            For driven nodes; the next step uses it.

        Returns
        -------
        x : (n, dim) m
        force : (n, dim) N
            Sum of all forces on the node, loads included. What holds a driven or fixed node bears its negative.
        """
        (words,) = self._board.exchange([self.payload(velocity)])
        raw = Q(self._board.parameters.formats.state, 0).from_bits(np.array(words)).reshape(len(self._nodes), 2, AXES)
        scene, units, fmt = self._encoded.scene, self._encoded.units, self._encoded.image.formats
        x, force = (q.to_float(raw[:, n, : scene.dim]) for n, q in enumerate((fmt.position, fmt.accumulator)))
        return x * units.size + units.centre, force * units.force

    def payload(self, velocity=None) -> bytes:
        """Return the payload of the command."""
        parts, items = [], self._items
        if velocity is not None:
            fmt, units = self._encoded.image.formats, self._encoded.units
            raw = raw_vectors(np.asarray(velocity) / units.velocity, fmt.velocity)
            mask = (1 << fmt.state) - 1
            for rank, words in zip(self._ranks, raw.tolist(), strict=True):
                parts.append(items.head(Kind.WRITE, self._address(NODE_STATE[AXES], rank), AXES, across=True))
                parts += [items.pack(word & mask) for word in words]
        for rank in self._ranks:
            for word in (NODE_STATE[0], NODE_FORCE[0]):
                parts.append(items.head(Kind.READ, self._address(word, rank), AXES, across=True))
        return b"".join(parts)

    def _address(self, word, rank):
        return self._map.address(Region.NODE, word, int(rank))


def most_nodes(items: Items) -> int:
    """Return the most nodes that fit one exchange."""
    return min(items.command_most // (ASKED_ITEMS + MOVED_ITEMS), items.answer_most // READ_ITEMS)


def line_bytes(nodes: int, items: Items, moved: bool = True) -> tuple[int, int]:
    """Return an exchange's bytes on the line for so many nodes: (to the circuit, from it)."""
    asked = nodes * (ASKED_ITEMS + moved * MOVED_ITEMS) * items.bytes
    given = (1 + nodes * READ_ITEMS) * items.bytes
    return tuple(len(Frame(1, 1, payload=b"\1" * count).packed(b"")) for count in (asked, given))
