"""The time of a step: cycles counted in a circuit's run, and the time on each board whose clock is known."""

from __future__ import annotations

from golden.datapath.rk4 import RK4
from golden.physics.scene import Scene
from golden.support.errors import InputError
from sim.encode import limits
from sim.results.result import Result


def count(scene: Scene, result: Result) -> dict:
    """Return ``cycles_per_step`` and ``occupancy`` (edges issued per lane and cycle) of a circuit's run; else None."""
    if result.cycles is None:
        return {"cycles_per_step": None, "occupancy": None}
    issued = RK4.stages * len(scene.mesh.edges) * scene.steps
    return {"cycles_per_step": result.cycles / scene.steps, "occupancy": issued / (result.lanes * result.cycles)}


def on_boards(scene: Scene, folder=None) -> list[dict]:
    """Return the time of a step on each board whose device the tools time.

    ``timed`` says whether there is a timing result of the board, which has ``lanes``, ``updates``, ``axes`` and
    ``clock_mhz`` of its circuit; ``fits`` whether that circuit holds the scene. If so, ``cycles_per_step`` is that of
    the cycle model (`sim.results.cycles`), from which ``step_us`` and ``real_time`` (simulated time / time) follow.
    """
    from hw.boards import board as boards
    from hw.boards.result import Timing, published  # Amaranth is slow to load

    results = published(Timing, folder)
    return [
        {"board": name, "timed": name in results} | (_timed(scene, results[name]) if name in results else {})
        for name in boards.timed()
    ]


def clock(board: str, folder=None) -> float:
    """Return the clock (MHz) of a board's timing result. Raises `InputError` if there is none."""
    from hw.boards.result import Timing, published

    timing = published(Timing, folder).get(board)
    if timing is None:
        raise InputError(f"--clock must be given, as {board} has not been timed (make timing BOARD={board})")
    return timing.clock_mhz


def _timed(scene: Scene, timing) -> dict:
    from hw.parameters import Parameters
    from hw.sizes import sizes_of
    from sim.results.cycles import Wavefront

    parameters = Parameters(**sizes_of(timing.circuit))
    sizes = {"lanes": parameters.lanes, "updates": parameters.updates, "axes": parameters.axes}
    entry = sizes | {"clock_mhz": timing.clock_mhz}
    try:
        cycles = Wavefront(limits.encode_checked(scene).image, parameters).per_step()
    except InputError:  # the circuit is too small
        return entry | {"fits": False}
    step_us = cycles / timing.clock_mhz
    return entry | {"fits": True, "cycles_per_step": cycles, "step_us": step_us, "real_time": scene.dt * 1e6 / step_us}
