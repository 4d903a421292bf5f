"""The frame for timing: every port of the circuit is connected to a register of it, and it is small."""

import re

from hw_objects import core_to_ask, only_asked

from hw.boards.flow import SMALLEST
from hw.boards.frame import FRAME, Frame
from hw.emit.verilog import convert
from hw.parameters import Parameters


def test_the_frame_connects_every_port_and_is_small():
    with only_asked():
        core = core_to_ask(Parameters(**SMALLEST))
        text = convert(Frame(core), FRAME)
    ports = {"__".join(map(str, path)): len(port) for path, _, port in core.signature.flatten(core)}
    for port in ports:
        assert f".{port}(" in text
    assert f"\nmodule {FRAME}(" in text and " rheogate core (" in text
    registers = {name: int(high) + 1 for high, name in re.findall(r"^  reg \[(\d+):0\] (\w+)", text, re.MULTILINE)}
    assert registers.pop("reset_registers") == 2 and registers.keys() == {"feed", "gathered"}
    assert sum(registers.values()) == sum(ports.values())
