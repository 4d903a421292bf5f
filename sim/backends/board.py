"""The backend that computes in a circuit on a board, at the other end of a serial link."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from golden.support.errors import InputError
from sim.backends.backend import IntegerBackend, Option
from sim.backends.machine import ClockedMachine
from sim.backends.rtl import check_room
from sim.encode.encode import EncodedScene
from sim.support.arguments import whole

if TYPE_CHECKING:
    from sim.backends.link.board import Board


@dataclass(frozen=True)
class BoardBackend(IntegerBackend):
    """A circuit on a board: behind a ``link`` that is open already, or at a ``port`` (any URL of pyserial's)."""

    link: Board | None = None
    port: str | None = None
    baud: int | None = None

    name = "board"
    words = "board"
    summary = "a circuit on a board"
    options = (
        Option("port", "a serial port or any other URL of pyserial's, as socket://127.0.0.1:5000", {"metavar": "URL"}),
        Option("baud", "bits a second (1000000)", {"type": whole, "metavar": "N"}),
    )

    @classmethod
    def from_options(cls, args: Namespace, out: Path) -> BoardBackend:
        """Return the backend that the command line asks for. Raises `InputError` without a port."""
        if not args.port:
            raise InputError("--port must say where the board is (make doctor lists the ports of this machine)")
        return cls(port=args.port, baud=args.baud)

    def check(self) -> None:
        """Raise `InputError` where there is neither a link nor a port."""
        if self.link is None and self.port is None:
            raise InputError(f"link must be given for the backend {self.name}")

    @contextmanager
    def open(self, encoded: EncodedScene) -> Iterator[ClockedMachine]:
        """Give the circuit, loaded and verified; its link is closed in the end."""
        from sim.backends.circuit import CircuitMachine
        from sim.backends.link.board import BAUD, Board

        link = self.link or Board.at(self.port, self.baud or BAUD)
        try:
            try:
                check_room(encoded, link.parameters)
            except InputError as error:
                raise InputError(f"{error}: choose a smaller object, or build a circuit that holds it") from None
            yield CircuitMachine(encoded.image, link, verify=link.verify)
        finally:
            link.close()
