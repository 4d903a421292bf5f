"""``python -m hw docs``: bring the generated tables and pictures up to date."""

from pathlib import Path

from golden.support.paths import ROOT
from hw.docs.pages import PAGES, updated
from hw.docs.pictures import PICTURES
from hw.parameters import Parameters


def add_options(command) -> None:
    """It has none."""


def run(args) -> int:
    for name, tables in PAGES.items():
        path = ROOT / name
        refresh(path, updated(path.read_text(encoding="utf-8"), tables))
    for name, draw in PICTURES.items():
        refresh(ROOT / name, draw(Parameters()))
    return 0


def refresh(path: Path, text: str) -> None:
    """Write ``text`` to ``path`` if it differs, and say which it was."""
    fresh = path.exists() and path.read_text(encoding="utf-8") == text
    if not fresh:
        path.write_text(text, encoding="utf-8")
    print(f"{path.relative_to(ROOT)}: {'up to date' if fresh else 'written anew'}")
