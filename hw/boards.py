"""The boards a circuit is built for: one file each below constraints/, named after the board."""

from __future__ import annotations

import tomllib
from pathlib import Path

from msgspec import Struct

from golden import schema
from golden.errors import InputError
from golden.schema import Count, Positive

from .parameters import Parameters

FOLDER = Path(__file__).parents[1] / "constraints"
DEVICES = {"ecp5": ("12k", "25k", "45k", "85k")}
"""What place and route calls the devices of a family."""


class Holds(Struct, forbid_unknown_fields=True):
    luts: Count
    ffs: Count
    multipliers: Count
    block_rams: Count


class Limits(Struct, forbid_unknown_fields=True):
    """Highest clocks of the hard blocks with all of their registers, which place and route doesn't time."""

    multiplier: Positive
    block_ram: Positive


class Circuit(Struct, forbid_unknown_fields=True):
    lanes: int
    updates: int
    nodes: int
    edges: int
    materials: int
    tables: int


class Board(Struct, forbid_unknown_fields=True):
    family: str
    device: str
    package: str
    grade: Count
    target_mhz: Positive  # what place and route aims at
    holds: Holds
    limits_mhz: Limits
    circuit: Circuit  # what is built unless something else is asked for

    def parameters(self, **chosen: int | None) -> Parameters:
        """The board's circuit, but for what is ``chosen``. Raises ValueError as `Parameters` does."""
        sizes = {name: getattr(self.circuit, name) for name in self.circuit.__struct_fields__}
        sizes |= {name: size for name, size in chosen.items() if size is not None}
        return Parameters(**sizes, family=self.family)


def names(folder: Path = FOLDER) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.toml"))


def load(name: str, folder: Path = FOLDER) -> Board:
    """The board of a name. Raises `InputError`: the file, the path of the key in it, and what it must be."""
    if name not in names(folder):
        raise InputError(f"--board must be {' or '.join(names(folder))}, not {name!r}")
    path = folder / f"{name}.toml"
    try:
        return _checked(schema.convert(tomllib.loads(path.read_text(encoding="utf-8")), Board))
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"{path}: the board must be a TOML file: {error}") from None
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def _checked(board: Board) -> Board:
    for key, known in (("family", DEVICES), ("device", DEVICES.get(board.family))):
        if (value := getattr(board, key)) not in known:
            raise InputError(f"{key} must be {' or '.join(known)}, not {value!r}")
    try:
        board.parameters()
    except ValueError as error:
        raise InputError(str(error)).under("circuit") from None
    return board
