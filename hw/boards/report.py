"""The report of place and route, in the design's own names."""

import re

from msgspec import Struct

from hw.boards.frame import CORE
from hw.families.flow import Flow
from hw.families.resources import Resources


class Step(Struct, forbid_unknown_fields=True):
    """A part of a path: the signal that it goes through, and its delay, routing included."""

    name: str
    ns: float


# The tools append to a part of a cell "$..." and to a memory its row, column and pin, or the index of
# a word where the memory is made of registers
MEMORY_SITE = re.compile(r"(?:(?:\.\d+)+(?:_[A-Z]+\d*(?:_\d+)?)?|\[\d+\])$")
CLOCKED = "posedge "


def placed(report: dict, flow: Flow) -> Resources:
    """The resources in use after place and route."""
    return flow.placed_cells.resources({kind: entry["used"] for kind, entry in report["utilization"].items()})


def fmax(report: dict) -> float:
    """The highest frequency of the only clock, in MHz."""
    (clock,) = report["fmax"].values()
    return round(clock["achieved"], 2)


def critical_path(report: dict, flow: Flow) -> list[Step]:
    """The longest path from register to register. Adjacent parts of the same name are one step."""
    paths = [
        path["path"]
        for path in report["critical_paths"]
        if path["from"].startswith(CLOCKED) and path["to"].startswith(CLOCKED)
    ]
    steps: list[Step] = []
    unnamed = 0.0  # of the tool's own cells, before the first that has a name in the design
    for part in max(paths, key=lambda path: sum(part["delay"] for part in path)):
        name = signal_name(part["to"]["cell"], flow)
        if steps and name in ("", steps[-1].name):  # the tool's own cells have no name and belong to the step before
            steps[-1].ns += part["delay"]
        elif name:
            steps.append(Step(name, unnamed + part["delay"]))
            unnamed = 0.0
        else:
            unnamed += part["delay"]
    return [Step(step.name, round(step.ns, 2)) for step in steps]


def signal_name(cell: str, flow: Flow) -> str:
    """The name in the design of the signal or memory that a cell implements."""
    name = cell.partition("$")[0]
    if flow.cell_suffix is not None:
        name, *_ = flow.cell_suffix.split(name)
    return MEMORY_SITE.sub("", name).removeprefix(f"{CORE}.")
