"""The figures by name: their scenes, the module that draws each, and the numbers that are read from it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from golden.support.errors import InputError
from sim.figures import reading
from sim.figures.reading import Reading
from sim.figures.runs import EDGE, Pair

MATERIALS = "viscoelastic", "rheological", "plastic"


@dataclass(frozen=True)
class Entry:
    """A figure: ``module`` of `sim.figures` has its ``draw`` and its ``film``."""

    title: str
    scenes: tuple[str, ...]
    module: str
    read: Callable[[Pair], list[Reading]]


def _solid(pair: Pair) -> list[Reading]:
    return [reading.bulge(pair), *reading.press(pair)]


def _pressed(material: str, what: str) -> Entry:
    return Entry(f"A {material} block, pressed, held and let go, {what}", (material,), "pressed", reading.press)


FIGURES = {
    "figure-1": Entry(
        "Single edges and blocks of the three materials, pressed, held and let go",
        (*(EDGE + name for name in MATERIALS), *MATERIALS),
        "curves",
        reading.press,
    ),
    "figure-3": _pressed("viscoelastic", "returns to its shape"),
    "figure-4": _pressed("plastic", "stays as it was pressed"),
    "figure-5": _pressed("rheological", "comes back part of the way"),
    "figure-6": Entry(
        "Blocks of the three materials in three dimensions: pressing the top makes the sides bulge",
        tuple(f"{name}-3d" for name in MATERIALS),
        "solid",
        _solid,
    ),
    "gravity": Entry(
        "A block under its own weight, with a linear and with a force-dependent damper (section 6)",
        ("gravity-collapses", "gravity-holds"),
        "gravity",
        lambda pair: [reading.fall(pair)],
    ),
}


def chosen(names: list[str]) -> list[str]:
    """Return the figures of these names, or all if there are none, in the order of `FIGURES`. Raises `InputError` for
    another name."""
    for name in names:
        if name not in FIGURES:
            raise InputError(f"NAME must be one of {', '.join(FIGURES)}, not {name!r}")
    return [name for name in FIGURES if name in names or not names]
