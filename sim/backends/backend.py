"""A backend: one way to compute a scene, as one object with its words, its options and its machine."""

from __future__ import annotations

from abc import ABC, abstractmethod
from argparse import ArgumentParser, Namespace
from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, ClassVar

from golden.datapath.memory_image import MemoryImage
from golden.physics.scene import Scene
from sim.backends.machine import FloatMachine, Machine
from sim.backends.witness import Witness
from sim.encode.encode import EncodedScene


@dataclass(frozen=True)
class Option:
    """An option on the command line that belongs to a backend; its value is None unless it is given.

    ``keywords`` are further arguments of `argparse.ArgumentParser.add_argument`.
    """

    name: str
    help: str
    keywords: Mapping[str, Any] = field(default_factory=dict)

    def add_to(self, parser: ArgumentParser, owner: str = "") -> None:
        """Add the option to a command; ``owner`` is put before its help."""
        parser.add_argument(f"--{self.name}", help=f"{owner}{self.help}", **self.keywords)


@dataclass(frozen=True)
class Backend(ABC):
    """One way to compute a scene. The fields of an instance are its settings.

    Attributes
    ----------
    name : str
        What ``--backend`` and `sim.run.run` call it.
    words : str
        What the report calls it.
    summary : str
        What the help of ``--backend`` says of it.
    integers : bool
        Whether it computes in the circuit's integers.
    compared : bool
        Whether it takes part in a comparison: it then has to run everywhere, without a device.
    options : tuple of Option
    """

    name: ClassVar[str]
    words: ClassVar[str]
    summary: ClassVar[str]
    integers: ClassVar[bool]
    compared: ClassVar[bool] = False
    options: ClassVar[tuple[Option, ...]] = ()

    @classmethod
    def from_options(cls, args: Namespace, out: Path) -> Backend:
        """Return the backend that the command line asks for; ``out`` is the folder that the run is written to."""
        return cls()

    @classmethod
    def settings(cls) -> set[str]:
        """Return the names of its settings."""
        return {setting.name for setting in fields(cls)}

    def check(self) -> None:  # noqa: B027 (most backends have nothing to check)
        """Raise `golden.support.errors.InputError` for settings that can't be used, before anything is run or
        written."""

    def connect(self) -> Backend:
        """Return the backend with its device reached, if it has one. Raises `golden.support.errors.InputError` if that
        can't be reached."""
        return self

    def close(self) -> None:  # noqa: B027 (most backends hold no device)
        """Let go of the device."""

    @abstractmethod
    def open(self, scene: Scene | EncodedScene) -> AbstractContextManager[FloatMachine | Machine]:
        """Return a context manager that gives a machine at the scene's start, once connected.

        A backend that computes ``integers`` gets the encoded scene and gives a `sim.backends.machine.Machine`; the
        others get the scene itself and give a `sim.backends.machine.FloatMachine`.
        """


@dataclass(frozen=True)
class IntegerBackend(Backend):
    """A backend that computes in the circuit's integers."""

    integers = True

    def check_room(self, encoded: EncodedScene) -> None:
        """Raise `golden.support.errors.InputError` for a scene that is too large."""

    def witness(self, image: MemoryImage) -> Witness | None:
        """Return a witness that computes single steps again, or None if its machine needs no such check."""
        return None
