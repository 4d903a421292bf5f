"""The generated pictures of docs/, by path."""

from hw.docs.core import core
from hw.docs.lane import lane

PICTURES = {"docs/lane.svg": lane, "docs/core.svg": core}
"""By path, the function that draws a picture of a circuit with some parameters."""
