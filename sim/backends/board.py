"""The backend that computes in a circuit on a board, at the other end of a serial link."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
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
    """A circuit on a board, over a ``link`` that is open already or at a ``port`` (any URL that pyserial opens)."""

    link: Board | None = None
    port: str | None = None
    baud: int | None = None

    name = "board"
    words = "board"
    summary = "a circuit on a board"
    options = (
        Option(
            "port",
            "a serial port or another pyserial URL, such as socket://127.0.0.1:5000",
            {"metavar": "URL"},
        ),
        Option("baud", "bits a second (1000000)", {"type": whole, "metavar": "N"}),
    )

    @classmethod
    def from_options(cls, args: Namespace, out: Path) -> BoardBackend:
        """Return the backend that the command line asks for. Raises `InputError` without a port."""
        if not args.port:
            raise InputError("--port must say where the board is (make doctor lists the ports of this machine)")
        return cls(port=args.port, baud=args.baud)

    def check(self) -> None:
        """Raise `InputError` if there is neither a link nor a port."""
        if self.link is None and self.port is None:
            raise InputError(f"link must be given for the backend {self.name}")

    def connect(self) -> BoardBackend:
        """Return the backend with a link to the circuit at its port, unless it has one."""
        from sim.backends.link.board import BAUD, Board

        self.check()
        return self if self.link else replace(self, link=Board.at(self.port, self.baud or BAUD))

    def close(self) -> None:
        """Close the link."""
        if self.link:
            self.link.close()

    @contextmanager
    def open(self, encoded: EncodedScene) -> Iterator[ClockedMachine]:
        """Give the circuit, loaded and verified."""
        from sim.backends.circuit import CircuitMachine

        try:
            check_room(encoded, self.link.parameters)
        except InputError as error:
            raise InputError(f"{error}: choose a smaller object, or build a circuit that holds it") from None
        yield CircuitMachine(encoded.image, self.link, verify=self.link.verify)
