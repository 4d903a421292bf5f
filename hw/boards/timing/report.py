"""What the tools' reports say, in the design's own terms."""

import re

from msgspec import Struct

from hw.boards.timing.frame import CORE, FRAME
from hw.families.cells import LOOKUP_TABLES, Sizes
from hw.families.cells import sizes as sizes_of

FAMILY = "ecp5"
"""The one that is timed."""


class Step(Struct, forbid_unknown_fields=True):
    """A part of a path: what it runs through, and the time this takes, the wires to it included."""

    name: str
    ns: float


# What the tools append to a name: of a part of a cell "$..", of a cell its kind and pin, of a memory its place and pin
KIND = re.compile(r"[._](?:LUT4|CCU2C|PFUMX|L6MUX21|TRELLIS_[A-Z0-9]+|MULT18X18D|DP16KD|PDPW16KD)(?:_|$)")
PLACE = re.compile(r"(?:\.\d+)+(?:_[A-Z]+\d*(?:_\d+)?)?$")
CLOCKED = "posedge "


def sizes(statistics: dict) -> tuple[Sizes, Sizes]:
    """(of the circuit, of the frame around it) as synthesised, from Yosys' statistics."""
    frame = sizes_of(statistics["modules"]["\\" + FRAME]["num_cells_by_type"], FAMILY)
    return sizes_of(statistics["design"]["num_cells_by_type"], FAMILY) - frame, frame


def placed(report: dict) -> Sizes:
    """What place and route made of all that was synthesised: it adds cells where a carry leaves its chain."""
    used = {name: entry["used"] for name, entry in report["utilization"].items()}
    return Sizes(
        lut=used["TRELLIS_COMB"],
        ff=used["TRELLIS_FF"],
        multipliers=used["MULT18X18D"],
        block_rams=used["DP16KD"],
        lut_ram=LOOKUP_TABLES[FAMILY]["TRELLIS_DPR16X4"] * used["TRELLIS_RAMW"],
    )


def fmax(report: dict) -> float:
    """MHz, of the only clock."""
    (clock,) = report["fmax"].values()
    return round(clock["achieved"], 2)


def critical_path(report: dict) -> list[Step]:
    """The longest path from register to register; parts of the same name in a row are one step."""
    paths = [
        path["path"]
        for path in report["critical_paths"]
        if path["from"].startswith(CLOCKED) and path["to"].startswith(CLOCKED)
    ]
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
