"""The generic family: no primitives, no devices."""

from pathlib import Path

from hw.families.family import Family

FAMILY = Family(Path(__file__).parent)
