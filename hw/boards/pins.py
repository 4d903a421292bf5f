"""A board's pins against the ports of its top."""

import re

from golden.support.errors import InputError
from hw.families.target import Pin


def directions(verilog: str, module: str) -> dict[str, str]:
    """Return "in" or "out" for each port of a module in Verilog; all ports are one bit."""
    (body,) = re.findall(rf"^module {module}\(.*?^endmodule", verilog, re.DOTALL | re.MULTILINE)
    return {name: way for way, name in re.findall(r"^  (in|out)put (?:wire |reg )?(\w+)\s*;", body, re.MULTILINE)}


def check(pins: dict[str, Pin], verilog: str, module: str) -> None:
    """Raise `InputError` for a port without a pin, a pin without a port, or the drive strength of an input."""
    ports = directions(verilog, module)
    for name in [*ports, *pins]:
        if name not in pins:
            raise InputError(f"pins.{name} must be given: {module} has that port")
        if name not in ports:
            raise InputError(f"pins.{name} must not be there: the ports of {module} are {', '.join(sorted(ports))}")
    for name, pin in pins.items():
        if pin.drive is not None and ports[name] == "in":
            raise InputError(f"pins.{name}.drive must be of an output, which {name} is not")
