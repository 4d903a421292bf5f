"""Device families: which hard blocks a circuit is made of."""

from pathlib import Path

from hw.families.ecp5.blocks import Ecp5
from hw.families.gowin.blocks import Gowin

FAMILIES = {"generic": None, "ecp5": Ecp5(), "gowin": Gowin()}
"""By name, what the blocks are told as Amaranth's ``platform``: they ask it for the family's own module.

Without one they are plain Amaranth, which simulates as it is and leaves the choice of blocks to the tools.
"""

MODELS = {family: Path(__file__).with_name(family) / "models.v" for family in ("ecp5", "gowin")}
"""By name, behavioural models of the primitives that a family's modules place."""
