"""A family of devices as one object: everything that differs from one vendor's devices to another's."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from amaranth.hdl import Module
from msgspec import Struct

from hw.families.flow import Flow
from hw.families.pll import ClockSource, NoPll
from hw.families.resources import Capacity
from hw.pipeline.cost import Cost


class Limits(Struct, forbid_unknown_fields=True):
    """Highest clocks in MHz of the hard blocks with all of their registers in use."""

    multiplier: float
    block_ram: float

    @property
    def lowest(self) -> float:
        return min(self.multiplier, self.block_ram)


class Blocks:
    """Modules made of a family's primitives for the components of `hw.blocks`, which ask for them in ``elaborate``:
    this object is Amaranth's ``platform``.

    Each method returns a module with the component's ports, latency and bits, or None where the family has nothing
    better than the generic module.
    """

    def get_multiplier(self, multiplier) -> Module | None:
        return None

    def get_shift_stage(self, stage) -> Module | None:
        return None

    def get_block_ram(self, ram) -> Module | None:
        return None


@dataclass(frozen=True)
class Family:
    """All that the project knows about a family of devices.

    Parameters
    ----------
    folder : Path
        The family's folder; its name is that of the family. Two files in it are optional: ``models.v``, behavioural
        models of the primitives that ``blocks`` places, and ``waivers.vlt``, the lint messages excused for them.
    blocks : Blocks, optional
        Modules of primitives. Without them the circuit is plain Amaranth, and synthesis chooses the hard blocks.
    cost : Cost
        Registers after each kind of operation, unless a circuit is given others.
    devices : mapping of str to Capacity
        By the name that the family's place and route knows the device by.
    pll : ClockSource
        Makes the circuit's clock from a board's oscillator.
    flow : Flow, optional
        Synthesis, place and route and packing. A family without a flow is for no board.
    limits_mhz : mapping of int to Limits
        By speed grade. Place and route times the paths between hard blocks, but not those inside them: a family is
        timed where its limits are known from elsewhere.
    """

    folder: Path
    blocks: Blocks | None = None
    cost: Cost = field(default_factory=Cost)
    devices: Mapping[str, Capacity] = field(default_factory=dict)
    pll: ClockSource = field(default_factory=NoPll)
    flow: Flow | None = None
    limits_mhz: Mapping[int, Limits] = field(default_factory=dict)

    @property
    def name(self) -> str:
        return self.folder.name

    @property
    def timed(self) -> bool:
        """True if the limits of the hard blocks are known, and so the clock that the circuit can have."""
        return bool(self.limits_mhz)

    @property
    def models(self) -> Path | None:
        return self._file("models.v")

    @property
    def waivers(self) -> Path | None:
        return self._file("waivers.vlt")

    def _file(self, name: str) -> Path | None:
        path = self.folder / name
        return path if path.exists() else None
