"""Device families: which hard blocks a circuit is made of."""

from pathlib import Path

from .ecp5 import Ecp5
from .gowin import Gowin

FAMILIES = {"generic": None, "ecp5": Ecp5(), "gowin": Gowin()}
"""By name, what the blocks are told as Amaranth's ``platform``: they ask it for the family's own module.

Without one they are plain Amaranth, which simulates as it is and leaves the choice of blocks to the tools.
"""

MODELS = {family: Path(__file__).with_name(f"{family}.v") for family in ("ecp5", "gowin")}
"""By name, behavioural models of the primitives that a family's modules place."""
