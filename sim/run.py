"""One `run(scene, backend)` for every way there is to compute a scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

import numpy as np

from golden.physics import model
from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from golden.support.errors import InputError
from sim.backends import machines
from sim.backends import waves as waveforms
from sim.encode import limits
from sim.encode.encode import Loaded
from sim.encode.switch import switch
from sim.encode.units import Units

COMPARED = "float", "fixed", "rtl"
BACKENDS = *COMPARED, "board"
LANES, UPDATES = 2, 1
CHECKS = 10  # steps of a run that the NumPy model computes again, if there are as many frames
REPORT_EVERY = 200  # steps between two calls of `progress`


@dataclass(frozen=True, eq=False)
class Raw:
    """The circuit's own integers at F frames, nodes and edges in the scene's order: what two runs must agree on."""

    x: np.ndarray  # (F, N, 3) int64, golden.datapath.formats position
    v: np.ndarray  # (F, N, 3) int64, velocity
    ratio: np.ndarray  # (F, E) int64, ratio

    def same(self, other: Raw) -> bool:
        """Whether every bit of every frame is the same."""
        return all(np.array_equal(getattr(self, name), getattr(other, name)) for name in ("x", "v", "ratio"))


@dataclass(frozen=True, eq=False)
class Result:
    """What a run gives. ``raw``, ``units`` and ``faults`` belong to the integer backends, ``cycles``, ``lanes``
    and ``updates`` to the circuit.

    A fault counts the saturations of a quantity, by the quantity's name; the circuit only tells 1 for "at least one".
    """

    backend: str
    trajectory: Trajectory
    seconds: float
    raw: Raw | None = None
    units: Units | None = None
    faults: dict[str, int] = field(default_factory=dict)
    cycles: int | None = None
    lanes: int | None = None
    updates: int | None = None

    @property
    def saturations(self) -> int:
        return sum(self.faults.values())


def run(
    scene: Scene,
    backend: str,
    *,
    lanes: int = LANES,
    updates: int = UPDATES,
    edge_order: np.ndarray | None = None,
    engine: str = "native",
    waves: Path | None = None,
    link=None,
    progress: Callable[[int], object] | None = None,
) -> Result:
    """Run a scene on float64, on the integer model or on the simulated circuit, and keep its frames.

    The integer backends give the force of the last Runge-Kutta stage before a frame, as the circuit does: a reaction
    is that of a state next to the frame's, and frame 0, before any step, has none (NaN on held nodes).

    Parameters
    ----------
    backend
        "float" (`golden.physics.model`), "fixed" (the integer model), "rtl" (the circuit's Verilog under Verilator) or
        "board" (a circuit behind a link).
    lanes, updates
        Edge processors and node updaters of the circuit; "rtl" only.
    edge_order
        (E,) permutation in which the integer backends work through the edges; the result is the same for any.
    engine
        What computes "fixed": "native", compiled, with steps of every phase and at least `CHECKS` in all computed
        again by the NumPy model; or "numpy", the NumPy model alone.
    waves
        File to which the circuit's waveforms are written (.fst or .vcd); "rtl" only.
    link
        The `sim.backends.link.board.Board`; "board" only. It is closed in any case.
    progress
        Called with the number of steps done, every 200 steps and at every frame.

    Raises
    ------
    InputError
        If an argument or a number of the scene cannot be used.
    InternalError
        If the compiled integer model disagrees with the NumPy model.
    """
    _check(scene, backend, edge_order, engine, waves, link)
    circuit = backend in ("rtl", "board")
    parameters = link.parameters if link else machines.parameters(lanes, updates) if circuit else None
    began = perf_counter()
    if backend == "float":
        trajectory = model.simulate(scene, progress)
        return Result("float", trajectory, perf_counter() - began)

    loaded = limits.load(scene, edge_order)
    with (
        machines.board(loaded.image, link)
        if link
        else machines.circuit(loaded.image, parameters, waves)
        if circuit
        else machines.integer_model(loaded.image, engine)
    ) as machine:
        for held in limits.later(loaded) if circuit else ():
            machines.check_room(held.image, parameters)
        witness = machines.Witness(loaded.image) if not circuit and engine != "numpy" else None
        frames = _frames(loaded, machine, witness, progress)
        raw = _raw(loaded, frames)
        return Result(
            backend,
            _trajectory(loaded, frames),
            perf_counter() - began,
            raw,
            loaded.units,
            faults={name: count for name, count in sorted(machine.faults.items()) if count},
            cycles=int(machine.cycles) if circuit else None,
            lanes=parameters.lanes if circuit else None,
            updates=parameters.updates if circuit else None,
        )


def _check(scene, backend, edge_order, engine, waves, link):
    if backend not in BACKENDS:
        raise InputError(f"backend must be one of {', '.join(BACKENDS)}, not {backend!r}")
    if engine not in machines.ENGINES:
        raise InputError(f"engine must be one of {', '.join(machines.ENGINES)}, not {engine!r}")
    if (link is not None) != (backend == "board"):
        raise InputError(
            f"link must go with the backend board, not {backend}"
            if link
            else "link must be given for the backend board"
        )
    if waves is not None and backend != "rtl":
        raise InputError(f"waves must go with the backend rtl, not {backend}: only the circuit has signals")
    if waves is not None:
        waveforms.check(waves)
    edges = len(scene.mesh.edges)
    if edge_order is not None and not np.array_equal(np.sort(edge_order), np.arange(edges)):
        raise InputError(f"edge_order must be a permutation of 0 to {edges - 1}")


def _frames(loaded: Loaded, machine, witness, progress) -> list[tuple[np.ndarray, ...]]:
    """(x, v, ratio, force) of the machine at every frame of the scene, in the circuit's order."""
    scene, kept, done = loaded.scene, [], 0
    wanted, checked = set(scene.frames.tolist()), checked_steps(scene) if witness else set()
    for phase in scene.phases:
        if phase.materials:
            loaded = switch(loaded, machine, phase.materials)
            if witness:
                witness = machines.Witness(loaded.image)
        machine.restart(loaded.start(phase, machine.v))
        if done == 0:
            kept.append(_state(machine))
        for stop in _stops(scene, done, done + phase.steps):
            if stop in checked:
                machine.step(stop - 1 - done)
                witness.step(machine, stop)
            else:
                machine.step(stop - done)
            done = stop
            if done in wanted:
                kept.append(_state(machine))
            if progress:
                progress(done)
    return kept


def _state(machine) -> tuple[np.ndarray, ...]:
    return tuple(np.array(part) for part in (machine.x, machine.v, machine.ratio, machine.force))


def _stops(scene: Scene, start: int, end: int) -> list[int]:
    """Steps after which a run pauses: frames, and every so many for the sake of `progress`."""
    stops = np.union1d(scene.frames, np.arange(0, end, REPORT_EVERY))
    return stops[(start < stops) & (stops <= end)].tolist()


def checked_steps(scene: Scene) -> set[int]:
    """Frames to which the last step is computed again: the ends of the phases and `CHECKS` more, evenly spread."""
    frames = scene.frames[1:]
    every = max(1, len(frames) // CHECKS)
    return {*frames[every - 1 :: every].tolist(), *np.cumsum([p.steps for p in scene.phases]).tolist()}


def _raw(loaded: Loaded, frames) -> Raw:
    def ordered(part, order):
        values = np.stack([frame[part] for frame in frames])
        result = np.empty_like(values)
        result[:, order] = values
        return result

    return Raw(ordered(0, loaded.node_order), ordered(1, loaded.node_order), ordered(2, loaded.edge_order))


def _trajectory(loaded: Loaded, frames) -> Trajectory:
    scene = loaded.scene
    x, v, a, force = map(
        np.array,
        zip(
            *(
                (loaded.positions(x), loaded.velocities(v), loaded.ratios(ratio), loaded.forces(force))
                for x, v, ratio, force in frames
            ),
            strict=True,
        ),
    )
    ends = np.cumsum([phase.steps for phase in scene.phases])
    current = np.searchsorted(ends, scene.frames)  # the frame at the end of a phase belongs to that phase
    held = np.array([phase.held for phase in scene.phases])[current]
    reaction = np.where(held[:, :, None], -force, 0.0)
    reaction[0, held[0]] = np.nan
    return Trajectory(scene.frames * scene.dt, x, v, a, reaction, scene.mesh.edges)
