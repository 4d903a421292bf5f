"""A board's pins: checked against the ports of its top, and written as each family's tools want them."""

import re

from golden.support.errors import InputError
from hw.boards.board import Board, Pin


def ports(verilog: str, module: str) -> dict[str, str]:
    """Of a module in Verilog, in or out by the name of the port. All are one bit."""
    (body,) = re.findall(rf"^module {module}\(.*?^endmodule", verilog, re.DOTALL | re.MULTILINE)
    return {name: way for way, name in re.findall(r"^  (in|out)put (?:wire |reg )?(\w+)\s*;", body, re.MULTILINE)}


def check(pins: dict[str, Pin], verilog: str, module: str) -> None:
    """Raises `InputError` naming the port or the pin if they aren't the same."""
    there = ports(verilog, module)
    for name in [*there, *pins]:
        if name not in pins:
            raise InputError(f"pins.{name} must be given: {module} has that port")
        if name not in there:
            raise InputError(f"pins.{name} must not be there: the ports of {module} are {', '.join(sorted(there))}")
    for name, pin in pins.items():
        if pin.drive is not None and there[name] == "in":
            raise InputError(f"pins.{name}.drive must be of an output, which {name} is not")


def lpf(board: Board) -> str:
    """For nextpnr-ecp5."""
    lines = [f'FREQUENCY PORT "clk" {board.oscillator_mhz:g} MHZ;']
    for port, pin in board.ports.items():
        drive = f" DRIVE={pin.drive}" if pin.drive else ""
        lines.append(f'LOCATE COMP "{port}" SITE "{pin.pin}";')
        lines.append(f'IOBUF PORT "{port}" IO_TYPE={pin.io} PULLMODE={pin.pull.upper()}{drive};')
    return "\n".join(lines) + "\n"


def cst(board: Board) -> str:
    """For nextpnr-himbaechel's Gowin."""
    lines = []
    for port, pin in board.ports.items():
        drive = f" DRIVE={pin.drive}" if pin.drive else ""
        lines.append(f'IO_LOC "{port}" {pin.pin};')
        lines.append(f'IO_PORT "{port}" IO_TYPE={pin.io} PULL_MODE={pin.pull.upper()}{drive};')
    return "\n".join(lines) + "\n"


def xdc(board: Board) -> str:
    """For Vivado. What comes from or goes to a pin waits for no clock."""
    lines = [f"create_clock -period {1000 / board.oscillator_mhz:.3f} [get_ports clk]"]
    pulls = {"up": " PULLUP TRUE", "down": " PULLDOWN TRUE", "none": ""}
    for port, pin in board.ports.items():
        drive = f" DRIVE {pin.drive}" if pin.drive else ""
        properties = f"PACKAGE_PIN {pin.pin} IOSTANDARD {pin.io}{pulls[pin.pull]}{drive}"
        lines.append(f"set_property -dict {{ {properties} }} [get_ports {port}]")
    lines.append("set_false_path -from [get_ports -filter {DIRECTION == IN && NAME != clk}]")
    lines.append("set_false_path -to [all_outputs]")
    lines.append("set_property CFGBVS VCCO [current_design]")
    lines.append("set_property CONFIG_VOLTAGE 3.3 [current_design]")
    return "\n".join(lines) + "\n"
