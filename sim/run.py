"""Run a scene on any backend, and keep its frames."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack, closing
from pathlib import Path
from time import perf_counter

import numpy as np

from golden.physics.scene import Scene
from golden.physics.trajectory import Trajectory
from golden.support.errors import InputError
from sim.backends.backend import Backend, IntegerBackend
from sim.backends.fixed import NATIVE
from sim.backends.machine import ClockedMachine, Machine
from sim.backends.registry import BACKENDS, owners
from sim.backends.rtl import LANES, UPDATES
from sim.encode import limits
from sim.encode.encode import EncodedScene
from sim.encode.switch import switch
from sim.results.result import Raw, Result

CHECKS = 10  # steps of a run that a witness computes again, if there are as many frames
REPORT_EVERY = 200  # steps between two calls of ``progress``
State = tuple[np.ndarray, ...]
"""x, v, ratio and force of a machine."""


def run(
    scene: Scene,
    backend: str | Backend,
    *,
    lanes: int = LANES,
    updates: int = UPDATES,
    edge_order: np.ndarray | None = None,
    engine: str = NATIVE,
    waves: Path | None = None,
    link=None,
    progress: Callable[[int], object] | None = None,
) -> Result:
    """Run a scene on a backend and keep its frames.

    The integer backends give the force of the last Runge-Kutta stage before a frame, as the circuit does: a reaction
    is that of a state next to the frame's, and frame 0, before any step, has none (NaN on held nodes).

    Parameters
    ----------
    backend
        A name in `sim.backends.registry.BACKENDS`, which takes whichever of the settings ``lanes``, ``updates``,
        ``engine``, ``waves`` and ``link`` it has; or a backend that has its settings already.
    lanes, updates
        Edge processors and node updaters of the simulated circuit.
    edge_order
        (E,) permutation in which the integer backends work through the edges; the result is the same for any.
    engine
        What computes the integer model: "native", compiled, with steps of every phase and at least `CHECKS` in all
        computed again by the NumPy model; or "numpy", the NumPy model alone.
    waves
        File to which the simulated circuit's waveforms are written (.fst or .vcd).
    link
        The `sim.backends.link.board.Board` to a circuit; closed in any case.
    progress
        Called with the number of steps done, every 200 steps and at every frame.

    Raises
    ------
    InputError
        If an argument or a number of the scene cannot be used.
    InternalError
        If the compiled integer model disagrees with the NumPy model.
    """
    if not isinstance(backend, Backend):
        backend = _configured(backend, lanes=lanes, updates=updates, engine=engine, waves=waves, link=link)
    with ExitStack() as stack:
        backend = stack.enter_context(closing(backend.connect()))
        backend.check()
        _check_order(edge_order, len(scene.mesh.edges))
        began = perf_counter()
        if not backend.integers:
            machine = stack.enter_context(backend.open(scene))
            return Result(backend.name, machine.simulate(progress), perf_counter() - began)
        encoded = limits.encode_checked(scene, edge_order)
        machine = stack.enter_context(backend.open(encoded))
        frames = _frames(encoded, backend, machine, progress)
        counted = {}
        if isinstance(machine, ClockedMachine):
            sizes = machine.parameters
            counted = {"cycles": int(machine.cycles), "lanes": sizes.lanes, "updates": sizes.updates}
        return Result(
            backend.name,
            _trajectory(encoded, frames),
            perf_counter() - began,
            _raw(encoded, frames),
            encoded.units,
            faults={name: count for name, count in sorted(machine.faults.items()) if count},
            **counted,
        )


def _configured(name: str, **settings) -> Backend:
    """Return the backend called ``name`` with whichever of the settings it has; a setting that is None isn't given."""
    if name not in BACKENDS:
        raise InputError(f"backend must be one of {', '.join(BACKENDS)}, not {name!r}")
    kind = BACKENDS[name]
    own = kind.settings()
    for setting in ("waves", "link"):  # the others have defaults, so their presence asks for nothing
        if settings[setting] is not None and setting not in own:
            raise InputError(f"{setting} must go with the backend {owners(setting)}, not {name}")
    return kind(**{setting: value for setting, value in settings.items() if setting in own})


def _check_order(edge_order: np.ndarray | None, edges: int) -> None:
    if edge_order is not None and not np.array_equal(np.sort(edge_order), np.arange(edges)):
        raise InputError(f"edge_order must be a permutation of 0 to {edges - 1}")


def _frames(encoded: EncodedScene, backend: IntegerBackend, machine: Machine, progress) -> list[State]:
    """Run all phases; return the machine's state at every frame of the scene, in the circuit's order."""
    scene, kept, done = encoded.scene, [], 0
    witness = backend.witness(encoded.image)
    wanted, checked = set(scene.frames.tolist()), checked_steps(scene) if witness else set()
    for phase in scene.phases:
        if phase.materials:
            encoded = switch(encoded, machine, phase.materials)
            witness = backend.witness(encoded.image)
        machine.restart(encoded.start(phase, machine.v))
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


def _state(machine: Machine) -> State:
    return tuple(np.array(part) for part in (machine.x, machine.v, machine.ratio, machine.force))


def _stops(scene: Scene, start: int, end: int) -> list[int]:
    """Return the steps after which a run pauses: frames, and every so many to report progress."""
    stops = np.union1d(scene.frames, np.arange(0, end, REPORT_EVERY))
    return stops[(start < stops) & (stops <= end)].tolist()


def checked_steps(scene: Scene) -> set[int]:
    """Return the frames before which a witness checks a step: the ends of the phases and `CHECKS` more, evenly
    spread."""
    frames = scene.frames[1:]
    every = max(1, len(frames) // CHECKS)
    return {*frames[every - 1 :: every].tolist(), *np.cumsum([p.steps for p in scene.phases]).tolist()}


def _raw(encoded: EncodedScene, frames: list[State]) -> Raw:
    def ordered(part, order):
        values = np.stack([frame[part] for frame in frames])
        result = np.empty_like(values)
        result[:, order] = values
        return result

    return Raw(ordered(0, encoded.node_order), ordered(1, encoded.node_order), ordered(2, encoded.edge_order))


def _trajectory(encoded: EncodedScene, frames: list[State]) -> Trajectory:
    scene = encoded.scene
    x, v, a, force = map(
        np.array,
        zip(
            *(
                (encoded.positions(x), encoded.velocities(v), encoded.ratios(ratio), encoded.forces(force))
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
