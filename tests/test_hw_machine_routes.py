"""Constants drive the circuit: with another one it computes the same integers in its own cycles, or is not made."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from hw_objects import refused, simulate

from golden.datapath.formats import Formats
from hw.machine import accumulator, completion_counter, host_port, issue_register, memory_ports, node_copies
from hw.machine.accumulator import Accumulator
from hw.machine.completion_counter import CompletionCounter
from hw.machine.core import Core
from hw.machine.edge import EdgeDatapath, EdgeProcessor
from hw.machine.host_port import HostPort
from hw.machine.issue_register import IssueRegister
from hw.map.memory_map import Map
from hw.parameters import Parameters
from hw.pipeline.cost import Cost

ROOT = Path(__file__).resolve().parents[1]
SMALL = Parameters(lanes=1, nodes=4, edges=4, materials=2, tables=1)
FOLLOWED = {
    "hw/blocks/memory.py": ["READ_LATENCY = 2"],
    "hw/machine/routes.py": ["HANDOVER = 3", "CHOICE = 2", "COPIED = 1", "STAGED = 1", "PORT = 1"],
    "hw/machine/issued.py": ["NEAR = 1"],
    "hw/machine/core.py": ["LOADING = HANDOVER + 1"],
    "hw/machine/entry_memory.py": ["REGISTERS = 1"],
    "hw/machine/edge_memories.py": ["REGISTERS = 1"],
    "hw/machine/node_pipeline.py": ["NEAR = 1"],
    "hw/machine/accumulator.py": ["ANNOUNCED = READ_LATENCY + 1", "WRITTEN = 2", "READ = READ_LATENCY + 1"],
    "hw/machine/node_datapath.py": ["GATHERED = READ + 1"],
}
EACH = [(file, line) for file, lines in FOLLOWED.items() for line in lines]
CHECK = "tests/test_hw_machine_core.py::test_a_pressed_block"


def computes_the_same(folder, changes, circuit):
    """Run the check of a whole circuit on a copy of the sources with some constants larger by 1."""
    for package in ("golden", "hw", "sim", "tests"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__", "*.png"))
    shutil.copy(ROOT / "pyproject.toml", folder)
    for file, line in changes:
        name, value = line.split(" = ")
        text = (folder / file).read_text()
        changed = re.sub(rf"^{re.escape(line)}$", f"{name} = {value} + 1", text, flags=re.MULTILINE)
        assert changed != text, (file, line)
        (folder / file).write_text(changed)
    command = [sys.executable, "-m", "pytest", "-q", f"{CHECK}[{circuit}]"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0 and "1 passed" in done.stdout, done.stdout[-2000:]


def test_a_circuit_with_longer_routes_computes_the_same(tmp_path):
    """All constants at once; each alone is a campaign."""
    computes_the_same(tmp_path, EACH, "2-2-3-press2-hold2")


@pytest.mark.campaign
@pytest.mark.parametrize("circuit", ["1-1-3-press0-hold0", "1-1-1-press3-hold3"])
@pytest.mark.parametrize(("file", "line"), EACH)
def test_a_circuit_with_one_longer_route_computes_the_same(file, line, circuit, tmp_path):
    computes_the_same(tmp_path, [(file, line)], circuit)


def register():
    return IssueRegister(width=4)


def counter():
    return CompletionCounter(width=4, first=0)


def sums():
    return Accumulator(formats=Formats(), nodes=4)


def core():
    simulate(Core(SMALL))


@pytest.mark.parametrize(
    ("module", "name", "value", "make", "message"),
    [
        (issue_register, "LATENCY", 2, register, "the latency of an issue register must be 1, not 2"),
        (completion_counter, "LATENCY", 0, counter, "the latency of a completion counter must be 1, not 0"),
        (accumulator, "ANNOUNCED", 2, sums, "ANNOUNCED must be at least 3 cycles, not 2"),
        (accumulator, "WRITTEN", 1, sums, "WRITTEN must be at least 2 cycles, not 1"),
        (accumulator, "READ", 1, sums, "READ must be at least 2 cycles, not 1"),
        (node_copies, "COPIED", 0, core, "COPIED must be at least 1 register, not 0"),
        (memory_ports, "PORT", 0, core, "PORT must be at least 1 register, not 0"),
    ],
    ids=lambda value: value if isinstance(value, str) and value.isupper() else "",
)
def test_a_constant_that_no_circuit_can_follow_is_refused(module, name, value, make, message, monkeypatch):
    monkeypatch.setattr(module, name, value)
    refused(make, message)


def test_a_host_port_with_another_number_of_stages_is_refused(monkeypatch):
    monkeypatch.setattr(host_port, "STAGES", (*host_port.STAGES, "more"))
    refused(
        lambda: simulate(HostPort(Map(SMALL), 3)),
        "the last of a host port's stages must be the access, not ['access', 'more']",
    )


def accumulated(reset: bool) -> list[int]:
    """The sums on two nodes after a force on each, with a reset between announcement and force of the second."""
    dut, sums = Accumulator(formats=Formats(), nodes=2), []

    async def bench(ctx):
        for node in range(2):
            for cycle in range(accumulator.ANNOUNCED + accumulator.WRITTEN):
                ctx.set(dut.valid, cycle == 0)
                ctx.set(dut.first, 1)
                ctx.set(dut.node, node)
                ctx.set(dut.reset, reset and node == 1 and cycle == 1)
                ctx.set(dut.pull.x, 5)
                await ctx.tick()
        for node in range(2):
            ctx.set(dut.sum_row, node)
            await ctx.tick().repeat(accumulator.READ)
            sums.append(ctx.get(dut.sums[0].x))

    simulate(dut, bench)
    return sums


def test_a_near_reset_clears_what_is_announced_in_the_simulator_too():
    assert accumulated(reset=False) == [5, 5]
    assert accumulated(reset=True) == [5, 0]


def faults_seen(reset: bool) -> int:
    """Cycles with a fault, of an edge without length that has a reset on its way."""
    datapath = EdgeDatapath(Formats(), 1, Cost())
    dut, seen = EdgeProcessor(datapath), 0

    async def bench(ctx):
        nonlocal seen
        for cycle in range(datapath.schedule.latency + 5):
            ctx.set(dut.valid, cycle == 0)
            ctx.set(dut.reset, reset and cycle == 2)
            await ctx.tick()
            seen += ctx.get(dut.fault) != 0

    simulate(dut, bench)
    return seen


def test_a_near_reset_clears_an_edge_under_way_in_the_simulator_too():
    assert faults_seen(reset=False) > 0
    assert faults_seen(reset=True) == 0
