"""Tools for Xilinx: Yosys counts the cells; Vivado makes the bitstream from the Verilog and a script."""

from hw.families.flow import Design, Flow, keep_hierarchy
from hw.families.resources import Cells
from hw.families.target import Target

SCRIPT = """# For {device}: vivado -mode batch -source {name}.tcl, in this folder.
# It writes {name}.bit, unless the clock is missed.
read_verilog {name}.v
read_xdc {name}.xdc
synth_design -top {top} -part {device}
opt_design
place_design
phys_opt_design
route_design
report_utilization -file {name}.utilization.txt
report_timing_summary -file {name}.timing.txt
set slack [get_property SLACK [get_timing_paths]]
if {{$slack < 0}} {{
  error "the clock of {mhz:g} MHz is missed by [expr -$slack] ns: choose a lower clock_mhz in the board's file"
}}
write_bitstream -force {name}.bit
"""
PULLS = {"up": " PULLUP TRUE", "down": " PULLDOWN TRUE", "none": ""}


class XilinxFlow(Flow):
    constraints, bitstream = "xdc", "bit"
    vendor = "Vivado"
    cells = Cells(
        # The lookup tables of adders are cells of their own, beside the carry chain
        lut={
            **dict.fromkeys(("LUT1", "LUT2", "LUT3", "LUT4", "LUT5", "LUT6", "SRL16E", "SRLC32E"), 1),
            **{"RAM32M": 4, "RAM64M": 4},
        },
        lut_ram={"RAM32M": 4, "RAM64M": 4},
        ff=dict.fromkeys(("FDRE", "FDSE", "FDCE", "FDPE"), 1),
        multipliers={"DSP48E1": 1},
        block_rams={"RAMB18E1": 1, "RAMB36E1": 2},
    )

    def write_pins(self, target: Target) -> str:
        """Return the constraints. Paths from and to pins are false paths: all signals there are asynchronous."""
        lines = [f"create_clock -period {1000 / target.oscillator_mhz:.3f} [get_ports clk]"]
        for port, pin in target.ports.items():
            drive = f" DRIVE {pin.drive}" if pin.drive else ""
            properties = f"PACKAGE_PIN {pin.pin} IOSTANDARD {pin.io}{PULLS[pin.pull]}{drive}"
            lines.append(f"set_property -dict {{ {properties} }} [get_ports {port}]")
        lines.append("set_false_path -from [get_ports -filter {DIRECTION == IN && NAME != clk}]")
        lines.append("set_false_path -to [all_outputs]")
        lines.append("set_property CFGBVS VCCO [current_design]")
        lines.append("set_property CONFIG_VOLTAGE 3.3 [current_design]")
        return "\n".join(lines) + "\n"

    def synthesise(self, design: Design) -> str:
        return f"{keep_hierarchy(design)}synth_xilinx -family xc7 -top {design.top}"

    def vendor_files(self, design: Design) -> dict[str, str]:
        target = design.target
        text = SCRIPT.format(device=target.device, name=design.name, top=design.top, mhz=target.clock_mhz)
        return {f"{design.name}.tcl": text}
