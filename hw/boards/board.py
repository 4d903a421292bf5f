"""The boards a circuit is built for: one file each below constraints/, named after the board."""

from __future__ import annotations

import tomllib
from pathlib import Path

from msgspec import Struct, defstruct

from golden.scene import schema
from golden.scene.schema import Count, Positive
from golden.support.errors import InputError
from golden.support.paths import BOARDS
from hw.families import FAMILIES
from hw.parameters import Parameters
from hw.sizes import SIZES, Size, shown, sizes_of

FOLDER = BOARDS
DEVICES = {
    "ecp5": ("12k", "25k", "45k", "85k"),
    "gowin": ("GW5AST-LV138FPG676AC1/I0",),
    "xilinx": ("xc7a100tcsg324-1",),
}
"""What the tools call the devices of a family."""
PULLS = "none", "up", "down"
TIMED = ("ecp5",)
"""Families whose multipliers and block RAMs the tools time, as far as `Limits` don't say more."""


class Holds(Struct, forbid_unknown_fields=True):
    luts: Count
    ffs: Count
    multipliers: Count
    block_rams: Count


class Limits(Struct, forbid_unknown_fields=True):
    """Highest clocks of the hard blocks with all of their registers, which place and route doesn't time."""

    multiplier: Positive
    block_ram: Positive


class Pin(Struct, forbid_unknown_fields=True):
    """Where a port of the board's top is, and its electrical side."""

    pin: str
    io: str  # standard, as the family's tools call it
    pull: str = "none"
    drive: Count | None = None  # mA
    active_low: bool = False  # of a button or a light


class Pins(Struct, forbid_unknown_fields=True):
    """By port of the board's top, `hw.boards.top.BoardTop`."""

    clk: Pin
    rx: Pin
    tx: Pin
    reset: Pin | None = None
    busy: Pin | None = None
    locked: Pin | None = None


def _field(size: Size):
    return (size.name, int, size.default) if size.optional else (size.name, int)


Circuit = defstruct("Circuit", map(_field, SIZES.values()), module=__name__, forbid_unknown_fields=True)
"""The sizes of a circuit, as fields."""


class Board(Struct, forbid_unknown_fields=True):
    family: str
    device: str
    package: str
    grade: Count
    target_mhz: Positive  # what place and route aims at when the circuit alone is timed
    oscillator_mhz: Positive
    clock_mhz: Positive  # the circuit's, on this board: what the PLL is asked for
    baud: int  # of the serial line
    loader: str  # what openFPGALoader calls the board
    pins: Pins
    holds: Holds
    circuit: Circuit  # what is built unless something else is asked for
    limits_mhz: Limits | None = None  # of the families that are `TIMED`
    crowded: bool = False  # nearly all of its lookup tables are used: see `hw.boards.timing.tools.options`

    @property
    def ports(self) -> dict[str, Pin]:
        """The pins that there are, by port."""
        pins = {port: getattr(self.pins, port) for port in self.pins.__struct_fields__}
        return {port: pin for port, pin in pins.items() if pin is not None}

    def parameters(self, **chosen: int | None) -> Parameters:
        """The board's circuit, but for what is ``chosen``. Raises ValueError as `Parameters` does."""
        sizes = sizes_of(self.circuit)
        sizes |= {name: size for name, size in chosen.items() if size is not None}
        return Parameters(**sizes, family=self.family if self.family in FAMILIES else "generic")


def names(folder: Path = FOLDER) -> list[str]:
    return sorted(path.stem for path in folder.glob("*.toml"))


def timed() -> list[str]:
    """The boards whose device the tools time."""
    return [name for name in names() if load(name).family in TIMED]


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


COLUMNS = " | ".join(size.name for size in SIZES.values() if size.column)
"""The columns of sizes in a table of boards."""


def cells_of(circuit: Circuit) -> list[str]:
    """The sizes below the columns `COLUMNS`."""
    return [text for name, text in shown(circuit).items() if SIZES[name].column]


def shares(sizes, board: Board) -> list[tuple[str, int, int]]:
    """(what, how many are used, how many the device holds)"""
    holds = board.holds
    return [
        ("LUT", sizes.lut, holds.luts),
        ("FF", sizes.ff, holds.ffs),
        ("multiplier", sizes.multipliers, holds.multipliers),
        ("block RAM", sizes.block_rams, holds.block_rams),
    ]


def too_many(sizes, board: Board) -> str:
    """What of the circuit is more than the device holds, or nothing."""
    over = [f"{used} {what}s of {holds}" for what, used, holds in shares(sizes, board) if used > holds]
    return ", ".join(over)


def fits(name: str, sizes, board: Board) -> None:
    """Raises `InputError` if the device holds less than the circuit takes."""
    if over := too_many(sizes, board):
        raise InputError(f"the circuit must fit {name}, not take {over}: choose fewer lanes, nodes or edges")


def _checked(board: Board) -> Board:
    for key, known in (("family", DEVICES), ("device", DEVICES.get(board.family))):
        if (value := getattr(board, key)) not in known:
            raise InputError(f"{key} must be {' or '.join(known)}, not {value!r}")
    if (board.family in TIMED) != (board.limits_mhz is not None):
        must = "be given" if board.family in TIMED else f"be given for {' or '.join(TIMED)} alone"
        raise InputError(f"limits_mhz must {must}")
    places: dict[str, str] = {}
    for port, pin in board.ports.items():
        if pin.pull not in PULLS:
            raise InputError(f"pins.{port}.pull must be {' or '.join(PULLS)}, not {pin.pull!r}")
        if (other := places.setdefault(pin.pin, port)) != port:
            raise InputError(f"pins.{port}.pin must be another one than that of {other}, not {pin.pin!r}")
    try:
        board.parameters()
    except ValueError as error:
        raise InputError(str(error)).under("circuit") from None
    return board
