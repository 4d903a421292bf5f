"""Statistics and reports as the tools give them, for tests in which no tool runs."""

from hw.boards.frame import FRAME
from hw.boards.report import Step
from hw.families.resources import Resources

STATISTICS = {
    "modules": {"\\rheogate": {}, f"\\{FRAME}": {"num_cells_by_type": {"LUT4": 39, "TRELLIS_FF": 106, "rheogate": 1}}},
    "design": {
        "num_cells_by_type": {
            "LUT4": 1039,
            "CCU2C": 300,
            "TRELLIS_DPR16X4": 5,
            "TRELLIS_FF": 2106,
            "PFUMX": 70,
            "MULT18X18D": 23,
            "DP16KD": 10,
            "PDPW16KD": 3,
        }
    },
}
USED = {"TRELLIS_COMB": 1739, "TRELLIS_FF": 2106, "TRELLIS_RAMW": 5, "MULT18X18D": 23, "DP16KD": 13, "DCCA": 1}
TIMED = Resources(lut=1700, ff=2000, multipliers=23, block_rams=13, lut_ram=20)
"""The resources in `reported`, without the frame in `STATISTICS`."""
CLOCK = "posedge $glbnet$clk$TRELLIS_IO_IN"
PATH = [
    ("clk-to-q", 0.52, "core.lane0.ram.words.0.0"),
    ("routing", 1.0, "core.queue.words.0.0$DPRAM_COMB2"),
    ("logic", 0.24, "core.queue.words.0.0$DPRAM_COMB2"),
    ("routing", 0.5, "core.queue.words.0.1_DO_1_CCU2C_B1$CCU2_COMB0"),
    ("logic", 0.44, "$nextpnr_CCU2C_241$CCU2_COMB0"),
    ("routing", 2.3, "core.sequencer.left_TRELLIS_FF_Q_21"),
    ("setup", 0.0, "core.sequencer.left_TRELLIS_FF_Q_21"),
]
STEPS = [Step("lane0.ram.words", 0.52), Step("queue.words", 2.18), Step("sequencer.left", 2.3)]
"""The steps of `PATH`."""


def reported(mhz: float, path=PATH) -> dict:
    """A report of place and route, in which a path from a pin is longer than ``path``."""
    parts = [{"type": kind, "delay": delay, "to": {"cell": cell}} for kind, delay, cell in path]
    return {
        "fmax": {CLOCK.removeprefix("posedge "): {"achieved": mhz, "constraint": 150}},
        "utilization": {name: {"used": used, "available": 10**6} for name, used in USED.items()},
        "critical_paths": [
            {"from": "<async>", "to": CLOCK, "path": [parts[0] | {"delay": 99.0}]},
            {"from": CLOCK, "to": CLOCK, "path": parts},
        ],
    }
