"""The Verilog of the circuit with its link."""

from hw.emit.verilog import convert, emit
from hw.families.registry import get_family
from hw.link.top import DEVICE, Linked
from hw.parameters import Parameters

LINKED = "rheogate_linked"


def emit_link(top: Linked, family: str) -> str:
    """Return the Verilog text with the module `LINKED` and its device, but not its core."""
    platform = get_family(family).blocks
    return f"{convert(top.device(), DEVICE, platform)}\n{convert(top, LINKED, platform)}"


def linked(parameters: Parameters, *, clock_hz: int, baud: int) -> tuple[str, Linked]:
    """Return the Verilog text with the module `LINKED`, and its source. Raises ValueError as `hw.link.top.Linked`."""
    text, core = emit(parameters)
    top = Linked(core, clock_hz=clock_hz, baud=baud)
    return f"{text}\n{emit_link(top, parameters.family)}", top
