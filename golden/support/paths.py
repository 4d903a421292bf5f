"""Folders of the checkout that more than one command uses."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
BOARDS = ROOT / "constraints"
SCENES = ROOT / "scenes"
BUILD = ROOT / "build"
