"""Generic blocks and their twins made of a family's primitives, simulated together by Verilator."""

import ctypes
from pathlib import Path

import numpy as np
from amaranth.hdl import Cat, Module
from amaranth.lib import wiring
from amaranth.lib.wiring import In, Out

from hw.emit.verilog import convert
from hw.families.registry import get_family
from sim.backends.verilated import library, opened

SHIM = Path(__file__).with_name("twins.cpp")
SLOT = 64
"""Bits for the inputs of one block, and for its output."""


class Blocks(wiring.Component):
    """Blocks side by side: each has a slot of ``inputs``, packed from the lowest bit, and a slot of ``outputs``."""

    def __init__(self, blocks):
        self._blocks = blocks
        super().__init__({"inputs": In(SLOT * len(blocks)), "outputs": Out(SLOT * len(blocks))})

    def elaborate(self, platform):
        m = Module()
        for number, block in enumerate(self._blocks):
            m.submodules[f"block_{number}"] = block
            ports = block.signature.members
            inputs = Cat(getattr(block, name) for name, member in ports.items() if member.flow == In)
            (output,) = (getattr(block, name) for name, member in ports.items() if member.flow == Out)
            assert max(len(inputs), len(output)) <= SLOT
            m.d.comb += inputs.eq(self.inputs.word_select(number, SLOT))
            m.d.comb += self.outputs.word_select(number, SLOT).eq(output.as_unsigned())
        return m


TOP = """module twins(input clk, input [{last}:0] in, output [{last}:0] generic, family);
  blocks_generic one(.clk(clk), .rst(1'b0), .inputs(in), .outputs(generic));
  blocks_{family} other(.clk(clk), .rst(1'b0), .inputs(in), .outputs(family));
endmodule
"""


def run(blocks, inputs: list[dict[str, np.ndarray]], folder: Path, family: str = "ecp5"):
    """Return the outputs of each block and of its twin in every cycle, before the rising clock edge, as bits.

    Parameters
    ----------
    blocks : list of components
        With one output each.
    inputs : list of dict of str to array
        Of each block, in every cycle.
    folder : Path
        To build in.
    family : str
    """
    texts = [convert(Blocks(blocks), f"blocks_{name}", get_family(name).blocks) for name in ("generic", family)]
    text = "\n".join(
        [TOP.format(last=SLOT * len(inputs) - 1, family=family), *texts, get_family(family).models.read_text()]
    )
    twins = opened(library("twins", text, SHIM, folder=folder)).twins
    stimulus = np.stack([_slot(block, values) for block, values in zip(blocks, inputs, strict=True)], axis=1)
    outputs = np.zeros((2, *stimulus.shape), np.uint64)
    pointers = [ctypes.c_void_p(array.ctypes.data) for array in (stimulus, *outputs)]
    twins(*pointers, ctypes.c_long(len(stimulus)))
    return list(zip(*outputs.swapaxes(1, 2), strict=True))


def _slot(block, values) -> np.ndarray:
    word, low = np.uint64(0), 0
    for name, member in block.signature.members.items():
        if member.flow == In:
            bits = len(getattr(block, name))
            word = word | (values[name].astype(np.uint64) & np.uint64((1 << bits) - 1)) << np.uint64(low)
            low += bits
    return word
