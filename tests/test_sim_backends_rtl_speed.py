"""The speed of the simulated circuit, which everybody who develops it waits for."""

from statistics import median
from time import process_time

import pytest
from rtl_objects import circuit, rtl_machine

from sim.encode.encode import encode
from sim.speed import meshes

LEAST = 200_000
"""Clock cycles a second, on one core."""


@pytest.mark.campaign
def test_four_busy_lanes_are_simulated_at_200_000_cycles_a_second():
    machine, speeds = rtl_machine(encode(meshes.scene("5x5x5")).image, parameters=circuit(4)), []
    machine.step(20)
    for _ in range(5):
        cycles, began = machine.cycles, process_time()
        machine.step(400)
        speeds.append((machine.cycles - cycles) / (process_time() - began))
    machine.close()
    print(f"{median(speeds):.0f} cycles a second, from {min(speeds):.0f} to {max(speeds):.0f}")
    assert median(speeds) >= LEAST
