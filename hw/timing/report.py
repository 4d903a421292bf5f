"""What the tools' reports say, in the design's own terms."""

import re

from msgspec import Struct

from .frame import CORE, FRAME


class Sizes(Struct, forbid_unknown_fields=True):
    """What the circuit takes of a device. ``lut`` counts all lookup tables, those of adders and memories included."""

    lut: int
    ff: int
    multipliers: int
    block_rams: int
    lut_ram: int

    def __sub__(self, other: "Sizes") -> "Sizes":
        return Sizes(*(getattr(self, name) - getattr(other, name) for name in self.__struct_fields__))


class Step(Struct, forbid_unknown_fields=True):
    """A part of a path: what it runs through, and the time this takes, the wires to it included."""

    name: str
    ns: float


# Lookup tables that a cell takes: an adder of two bits has two, a memory of 16x4 has four
LOOKUP_TABLES = {"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 4}
# What the tools append to a name: of a part of a cell "$..", of a cell its kind and pin, of a memory its place and pin
KIND = re.compile(r"[._](?:LUT4|CCU2C|PFUMX|L6MUX21|TRELLIS_[A-Z0-9]+|MULT18X18D|DP16KD|PDPW16KD)(?:_|$)")
PLACE = re.compile(r"(?:\.\d+)+(?:_[A-Z]+\d*(?:_\d+)?)?$")
CLOCKED = "posedge "


def sizes(statistics: dict) -> tuple[Sizes, Sizes]:
    """(of the circuit, of the frame around it) as synthesised, from Yosys' statistics."""
    frame = _sizes(statistics["modules"]["\\" + FRAME]["num_cells_by_type"])
    return _sizes(statistics["design"]["num_cells_by_type"]) - frame, frame


def _sizes(cells: dict[str, int]) -> Sizes:
    tables = {name: count * cells.get(name, 0) for name, count in LOOKUP_TABLES.items()}
    return Sizes(
        lut=sum(tables.values()),
        ff=cells.get("TRELLIS_FF", 0),
        multipliers=cells.get("MULT18X18D", 0),
        block_rams=cells.get("DP16KD", 0) + cells.get("PDPW16KD", 0),
        lut_ram=tables["TRELLIS_DPR16X4"],
    )


def placed(report: dict) -> Sizes:
    """What place and route made of all that was synthesised: it adds cells where a carry leaves its chain."""
    used = {name: entry["used"] for name, entry in report["utilization"].items()}
    return Sizes(
        lut=used["TRELLIS_COMB"],
        ff=used["TRELLIS_FF"],
        multipliers=used["MULT18X18D"],
        block_rams=used["DP16KD"],
        lut_ram=LOOKUP_TABLES["TRELLIS_DPR16X4"] * used["TRELLIS_RAMW"],
    )


def fmax(report: dict) -> float:
    """MHz, of the only clock."""
    (clock,) = report["fmax"].values()
    return round(clock["achieved"], 2)


def critical_path(report: dict) -> list[Step]:
    """The longest path from register to register; parts of the same name in a row are one step."""
    paths = [path["path"] for path in report["critical_paths"]
             if path["from"].startswith(CLOCKED) and path["to"].startswith(CLOCKED)]
    steps: list[Step] = []
    for part in max(paths, key=lambda path: sum(part["delay"] for part in path)):
        name = own_name(part["to"]["cell"])
        if steps and name in ("", steps[-1].name):  # the tool's own cells have no name: part of what they continue
            steps[-1].ns += part["delay"]
        else:
            steps.append(Step(name, part["delay"]))
    return [Step(step.name, round(step.ns, 2)) for step in steps]


def own_name(cell: str) -> str:
    """What the design calls that which a cell is made from."""
    name, *_ = KIND.split(cell.partition("$")[0])
    return PLACE.sub("", name).removeprefix(f"{CORE}.")
