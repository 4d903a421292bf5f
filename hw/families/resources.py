"""Resources of a device: how many a circuit takes, and how many a device has."""

from collections.abc import Mapping
from dataclasses import dataclass

from msgspec import Struct


class Resources(Struct, forbid_unknown_fields=True):
    """The resources that a circuit takes. ``lut`` counts all lookup tables, those of adders and memories included."""

    lut: int
    ff: int
    multipliers: int
    block_rams: int
    lut_ram: int  # lookup tables that are memories

    def __sub__(self, other: "Resources") -> "Resources":
        return Resources(
            lut=self.lut - other.lut,
            ff=self.ff - other.ff,
            multipliers=self.multipliers - other.multipliers,
            block_rams=self.block_rams - other.block_rams,
            lut_ram=self.lut_ram - other.lut_ram,
        )


class Use(Struct, frozen=True):
    """Use of one kind of resource."""

    what: str
    used: int
    available: int

    @property
    def fraction(self) -> float:
        return self.used / self.available


class Capacity(Struct, frozen=True, kw_only=True):
    """The resources that a device has."""

    luts: int
    ffs: int
    multipliers: int
    block_rams: int

    def use(self, taken: Resources) -> list[Use]:
        """The use of each kind of resource by a circuit that takes ``taken``."""
        return [
            Use("LUT", taken.lut, self.luts),
            Use("FF", taken.ff, self.ffs),
            Use("multiplier", taken.multipliers, self.multipliers),
            Use("block RAM", taken.block_rams, self.block_rams),
        ]

    def exceeded(self, taken: Resources) -> str:
        """Everything of which the circuit takes more than there is, as text; empty if it fits."""
        over = [use for use in self.use(taken) if use.used > use.available]
        return ", ".join(f"{use.used} {use.what}s of {use.available}" for use in over)


@dataclass(frozen=True, kw_only=True)
class Cells:
    """The resources that cells stand for, as a tool names the kinds of cells: the number that one cell takes."""

    lut: Mapping[str, int]
    lut_ram: Mapping[str, int]  # of lut
    ff: Mapping[str, int]
    multipliers: Mapping[str, int]
    block_rams: Mapping[str, int]

    def resources(self, counts: Mapping[str, int]) -> Resources:
        """Add up the cells of each kind; a kind that is in no mapping takes nothing."""

        def total(weights: Mapping[str, int]) -> int:
            return sum(weight * counts.get(kind, 0) for kind, weight in weights.items())

        return Resources(
            lut=total(self.lut),
            ff=total(self.ff),
            multipliers=total(self.multipliers),
            block_rams=total(self.block_rams),
            lut_ram=total(self.lut_ram),
        )
