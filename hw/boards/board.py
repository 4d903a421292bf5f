"""Boards for which circuits are built: a file each below constraints/, named after the board."""

from __future__ import annotations

import tomllib
from pathlib import Path

from msgspec import Struct, defstruct, structs

from golden.scene import schema
from golden.scene.schema import Count, Positive
from golden.support.errors import InputError
from golden.support.paths import BOARDS
from hw.families.family import Limits
from hw.families.registry import family_names, get_family
from hw.families.resources import Capacity
from hw.families.target import Pin
from hw.parameters import Parameters
from hw.sizes import SIZES, Size, sizes_of

FOLDER = BOARDS
PULLS = "none", "up", "down"


def _field(size: Size):
    return (size.name, int, size.default) if size.optional else (size.name, int)


Circuit = defstruct("Circuit", map(_field, SIZES.values()), module=__name__, forbid_unknown_fields=True)
"""The sizes of a circuit, as fields."""


class Pins(Struct, forbid_unknown_fields=True):
    """Pins by port of the board's top, `hw.boards.top.BoardTop`."""

    clk: Pin
    rx: Pin
    tx: Pin
    reset: Pin | None = None
    busy: Pin | None = None
    locked: Pin | None = None


class Board(Struct, forbid_unknown_fields=True):
    """A board's file; a `hw.families.target.Target`."""

    family: str
    device: str
    package: str
    grade: Count
    target_mhz: Positive  # the clock asked of place and route when the circuit alone is timed
    oscillator_mhz: Positive
    clock_mhz: Positive  # the circuit's clock on this board, which the PLL makes
    baud: int  # of the serial line
    loader: str  # openFPGALoader's name of the board
    pins: Pins
    circuit: Circuit  # the sizes unless others are given
    no_wide_luts: bool = False

    @property
    def ports(self) -> dict[str, Pin]:
        """The connected pins by port."""
        return {port: pin for port, pin in structs.asdict(self.pins).items() if pin is not None}

    @property
    def capacity(self) -> Capacity:
        return get_family(self.family).devices[self.device]

    @property
    def limits_mhz(self) -> Limits | None:
        """Limits of the device's hard blocks, if its family is timed."""
        return get_family(self.family).limits_mhz.get(self.grade)

    def parameters(self, **chosen: int | None) -> Parameters:
        """The board's circuit, with the sizes that are ``chosen``. Raises ValueError as `Parameters` does."""
        sizes = sizes_of(self.circuit)
        sizes |= {name: size for name, size in chosen.items() if size is not None}
        return Parameters(**sizes, family=self.family)


def names(folder: Path = FOLDER) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.toml"))


def timed() -> list[str]:
    """The boards whose family is timed."""
    return [name for name in names() if get_family(load(name).family).timed]


def load(name: str, folder: Path = FOLDER) -> Board:
    """Read a board's file. Raises `InputError` with the file, the path of the key in it, and what it must be."""
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
    _one_of("family", board.family, [name for name in family_names() if get_family(name).devices])
    family = get_family(board.family)
    _one_of("device", board.device, family.devices)
    if family.timed:
        _one_of("grade", board.grade, family.limits_mhz)
    owners: dict[str, str] = {}
    for port, pin in board.ports.items():
        _one_of(f"pins.{port}.pull", pin.pull, PULLS)
        if (owner := owners.setdefault(pin.pin, port)) != port:
            raise InputError(f"pins.{port}.pin must be another one than that of {owner}, not {pin.pin!r}")
    try:
        board.parameters()
    except ValueError as error:
        raise InputError(str(error)).under("circuit") from None
    return board


def _one_of(key: str, value, known) -> None:
    if value not in known:
        raise InputError(f"{key} must be {' or '.join(map(str, known))}, not {value!r}")
