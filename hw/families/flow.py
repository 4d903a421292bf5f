"""A family's flow: from Verilog to a placed circuit and its bitstream, as the commands that the tools are given."""

import re
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import ClassVar, NamedTuple

from hw.families.resources import Cells
from hw.families.target import Target


class Command(NamedTuple):
    """A program that a package of pip installs, and its arguments."""

    program: str
    arguments: tuple[str, ...]


class Design(NamedTuple):
    """A circuit for a device.

    All of its files lie in one folder, in which the tools are started: ``<name>.v``, the constraints,
    ``<name>.netlist.json`` after synthesis, ``<name>.<seed>.report.json`` after place and route, the bitstream.
    """

    name: str
    top: str
    hierarchy: tuple[str, ...]  # patterns of the modules that synthesis keeps apart, where it can
    target: Target
    pinned: bool  # the top's ports are the board's pins; otherwise place and route chooses the pins


class Flow(ABC):
    """The commands of a family's tools, which `hw.boards.tools` runs. Yosys does all synthesis.

    Attributes
    ----------
    constraints, bitstream : str
        Endings of the file with the pins and of the bitstream.
    programs : mapping of str to str
        The programs for place and route and for packing, and the packages of pip that bring them.
    vendor : str, optional
        The vendor's tool that places, routes and packs where the open tools can't.
    cells, placed_cells : Cells
        Kinds of cells in Yosys' statistics and in the report of place and route.
    cell_suffix : re.Pattern, optional
        Where the tools' additions begin in the name of a cell: its kind and pin, after the name of a signal.
    """

    constraints: str
    bitstream: str
    programs: ClassVar[Mapping[str, str]] = {}
    vendor: str | None = None
    cells: Cells
    placed_cells: Cells | None = None
    cell_suffix: re.Pattern | None = None

    @abstractmethod
    def write_pins(self, target: Target) -> str:
        """Return the text of the constraints: every pin, and the oscillator's frequency where the tools want it."""

    @abstractmethod
    def synthesise(self, design: Design) -> str:
        """Return the Yosys commands that make the netlist of the Verilog that has been read."""

    def place_and_route(self, design: Design, *, seed: int, mhz: float) -> Command:
        """Return the command that makes the report, and all that `pack` needs if the design is pinned; a clock that is
        missed is no failure. Not called if there is a vendor's tool."""
        raise NotImplementedError

    def pack(self, design: Design, *, seed: int) -> Command:
        """Return the command that makes the bitstream. Not called if there is a vendor's tool."""
        raise NotImplementedError

    def vendor_files(self, design: Design) -> dict[str, str]:
        """Return the files that the vendor's tool needs besides Verilog and constraints, by name: first its script."""
        return {}


def keep_hierarchy(design: Design) -> str:
    """Return the Yosys command that keeps the design's modules apart."""
    return f"setattr -mod -set keep_hierarchy 1 {' '.join(design.hierarchy)}\n"
