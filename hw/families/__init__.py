"""Device families: which hard blocks a circuit is made of."""

from pathlib import Path

from .ecp5 import Ecp5

FAMILIES = {"generic": None, "ecp5": Ecp5()}
"""By name, what the blocks are told as Amaranth's ``platform``: they ask it for the family's own module.

Without one they are plain Amaranth, which simulates as it is and leaves the choice of blocks to the tools.
"""

MODELS = {"ecp5": Path(__file__).with_name("ecp5.v")}
"""By name, behavioural models of the primitives that a family's modules place."""
