"""Write index.html and compare.json from comparisons; the page is one file that needs no other."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path

import jinja2
from matplotlib.colors import to_hex

from golden.physics.scene import Scene
from golden.support.files import write_text
from sim.backends.float64 import FloatBackend
from sim.backends.registry import BACKENDS
from sim.compare import compare, complete
from sim.report import pack, style
from sim.results import ranges, run_folder
from sim.results.comparison import Comparison, power, shortcomings
from sim.support.errors import about

FOLDER = Path(__file__).parent
DATA = "compare.json"
SCRIPTS = "data.js", "camera.js", "paint.js", "viewer.js", "chart.js", "ranges.js", "page.js"
SAMPLES = 33  # of a colour scale


@dataclass(frozen=True)
class Section:
    """A scene on the page."""

    entry: dict  # its object in compare.json
    description: str
    facts: list[str]
    looked: int  # frames whose ranges were measured
    drawn: dict  # the page's data, from sim.report.pack.scene

    @classmethod
    def of(cls, comparison: Comparison) -> Section:
        scene = comparison.scene
        return cls(
            comparison.entry(), scene.description, facts(scene), len(ranges.sampled(scene)), pack.scene(comparison)
        )


def section(scene: Scene, progress=None, *, lanes: int, updates: int) -> Section:
    """Run a scene on all backends that are compared, and pack it."""
    with about(scene):
        return Section.of(compare(scene, lanes=lanes, updates=updates, progress=progress))


def of_runs(scene: Scene, progress=None, *, folders: dict[str, dict[str, Path]]) -> Section:
    """Pack the runs of a scene that are in ``folders[name of the scene]``; float64, if it isn't there, is run."""
    with about(scene):
        runs = {backend: run_folder.load_result(folder)[1] for backend, folder in folders[scene.name].items()}
        return Section.of(complete(scene, runs, (FloatBackend.name,), progress=progress))


def write(sections: list[Section], folder: Path) -> None:
    """Write the page, and the figures that it shows as compare.json."""
    entries = [section.entry for section in sections]
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(FOLDER),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters |= {
        "brief": brief,
        "percent": percent,
        "shortcomings": shortcomings,
        "slug": slug,
        "si": si,
        "least": least,
    }
    page = environment.get_template("page.html.j2").render(
        sections=sections,
        entries=entries,
        backends={name: backend.words for name, backend in BACKENDS.items()},
        style=(FOLDER / "page.css").read_text(),
        script="\n".join((FOLDER / name).read_text() for name in SCRIPTS),
        data=[inlined(section.drawn | {"ranges": section.entry["ranges"]}) for section in sections],
        colours=inlined(colours()),
    )
    write_text(folder / DATA, json.dumps(entries, indent=2, allow_nan=False) + "\n")
    write_text(folder / "index.html", page)


def colours() -> dict[str, list[str]]:
    """Return each quantity's scale as colours from its lowest to its highest value."""
    return {name: [to_hex(scale(n / (SAMPLES - 1))) for n in range(SAMPLES)] for name, scale in style.scales().items()}


def inlined(value) -> str:
    """Return JSON that is safe inside a page's script element."""
    return json.dumps(value, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def facts(scene: Scene) -> list[str]:
    """Return phrases that describe the scene."""
    extent = " × ".join(f"{side * 1e3:.3g}" for side in scene.mesh.points.max(axis=0) - scene.mesh.points.min(axis=0))
    phases = ", ".join(f"{phase.name} {phase.steps * scene.dt:.3g} s" for phase in scene.phases)
    return [f"{extent} mm", phases, f"step {scene.dt * 1e3:.3g} ms"]


def least(ranges: list[dict]) -> dict:
    """Return the quantity with the least headroom among those with a unit; the others are bounded by definition."""
    free = [entry for entry in ranges if entry["unit"] and entry["headroom_bits"] is not None]
    return min(free, key=lambda entry: entry["headroom_bits"])


def slug(name: str) -> str:
    """Return the name as part of an address."""
    return re.sub(r"\W+", "-", name).strip("-").lower() or "scene"


def percent(part: float) -> str:
    return f"{round(100 * part, 1) + 0:.1f} %"  # + 0: no negative zero


def si(value: float, unit: str) -> str:
    """Return a quantity with a prefix to its unit: 0.0123 N is 12.3 mN. A pure number gets no prefix."""
    if not unit:
        return f"{float(f'{value:.3g}'):g}"
    for prefix, factor in (("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9), ("p", 1e-12)):
        if abs(value) >= factor:
            return f"{float(f'{value / factor:.3g}'):g} {prefix}{unit}".replace("-", "−")
    return f"0 {unit}"


def brief(value) -> str:
    """Return a figure for reading: yes or no, whole numbers in full, others with two digits."""
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return "0" if value == 0 else power(value) if value < 0.01 else f"{value:.3g}"
    return f"{value:,}".replace(",", "\u202f") if isinstance(value, int) else str(value)
