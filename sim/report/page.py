"""index.html and compare.json from what was compared."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path

from golden.files import write_text
from golden.problem import Scene
from sim.compare import compare, power, shortcomings
from sim.errors import about


@dataclass(frozen=True)
class Section:
    """A scene on the page."""

    entry: dict  # its object in compare.json
    description: str
    facts: list[str]
    pictures: dict[str, str]  # "shapes", "curves" -> name of the file beside the page


def section(scene: Scene, progress=None, *, lanes: int, updates: int, folder: Path) -> Section:
    """Compare a scene and draw it: the pictures go to the folder."""
    from sim.report import curves, shapes

    with about(scene):
        comparison = compare(scene, lanes=lanes, updates=updates, progress=progress)
    figures = {"shapes": shapes.draw(comparison), "curves": curves.draw(comparison)}
    pictures = {kind: f"{slug(scene.name)}-{kind}.png" for kind in figures}
    for kind, figure in figures.items():
        figure.savefig(folder / pictures[kind], dpi=150)
    return Section(comparison.entry(), scene.description, facts(scene), pictures)


def write(sections: list[Section], folder: Path) -> None:
    """Write the page and the figures that it shows."""
    import jinja2

    entries = [section.entry for section in sections]
    loader = jinja2.FileSystemLoader(Path(__file__).parent)
    environment = jinja2.Environment(
        loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    environment.filters |= {"brief": brief, "percent": percent, "shortcomings": shortcomings, "slug": slug}
    page = environment.get_template("page.html.j2").render(sections=sections, entries=entries)
    write_text(folder / "compare.json", json.dumps(entries, indent=2, allow_nan=False) + "\n")
    write_text(folder / "index.html", page)


def facts(scene: Scene) -> list[str]:
    """What the scene is, in phrases."""
    extent = " × ".join(f"{side * 1e3:.3g}" for side in scene.mesh.points.max(axis=0) - scene.mesh.points.min(axis=0))
    phases = ", ".join(f"{phase.name} {phase.steps * scene.dt:.3g} s" for phase in scene.phases)
    return [f"{extent} mm", phases, f"step {scene.dt * 1e3:.3g} ms"]


def slug(name: str) -> str:
    """The name as part of a file's name and of an address."""
    return re.sub(r"\W+", "-", name).strip("-").lower() or "scene"


def percent(part: float) -> str:
    return f"{round(100 * part, 1) + 0:.1f} %"  # + 0: no negative zero


def brief(value) -> str:
    """A figure as it is read: yes or no, whole numbers in full, others with two digits."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return "0" if value == 0 else power(value) if value < 0.01 else f"{value:.3g}"
    return f"{value:,}".replace(",", "\u202f") if isinstance(value, int) else str(value)
