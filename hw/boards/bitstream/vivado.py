"""The script with which Vivado makes a bitstream of the files beside it."""

from hw.boards.board import Board

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


def script(board: Board, name: str, top: str) -> str:
    return SCRIPT.format(device=board.device, name=name, top=top, mhz=board.clock_mhz)
