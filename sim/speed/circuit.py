"""Cycles of the circuit's step, by the counter of the simulated circuit."""

from __future__ import annotations

from golden.errors import InputError, InternalError
from golden.problem import Scene
from sim import limits, machines

NODES = 1024  # room for every mesh of the benchmark; it has no influence on the cycles
STEPS = 10


def cycles_per_step(scene: Scene, lanes: int, updates: int) -> int:
    """Clock cycles that each more step of a run takes.

    Parameters
    ----------
    lanes
        Edge processors.
    updates
        Nodes updated in a cycle.

    Raises
    ------
    InputError
        If there is no such circuit or it has no room for the scene.
    InternalError
        If steps differ.
    """
    if updates != 1:
        raise InputError(f"updates must be 1, not {updates!r}")
    from hw.parameters import Parameters
    from sim.rtl import RtlMachine  # Amaranth and Verilator are slow to load

    try:
        parameters = Parameters(lanes=lanes, nodes=NODES)
    except ValueError as error:
        raise InputError(str(error)) from None
    machine = RtlMachine(limits.load(scene).image, parameters=parameters, folder=machines.BUILD)
    try:
        runs = [_run(machine, 1 + more * STEPS) for more in range(3)]
    finally:
        machine.close()
    if runs[2] - runs[1] != runs[1] - runs[0] or (runs[1] - runs[0]) % STEPS:
        raise InternalError(f"every step must take as many cycles, but 1, {1 + STEPS} and {1 + 2 * STEPS} steps "
                            f"took {runs[0]}, {runs[1]} and {runs[2]}")
    return (runs[1] - runs[0]) // STEPS


def _run(machine, steps: int) -> int:
    """Cycles of a run of so many steps."""
    before = machine.cycles
    machine.step(steps)
    return machine.cycles - before
