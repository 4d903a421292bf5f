"""The energies of a run and the forces of its edges: float64's formulas on the states that were kept."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from golden.physics.model import Model
from golden.physics.scene import Phase, Scene
from golden.physics.trajectory import Trajectory


def edge_forces(scene: Scene, run: Trajectory) -> np.ndarray:
    """Return (F, E) the edges' forces (N), positive where an edge pushes its ends apart, as under compression."""
    model, forces = Model(scene), np.empty(run.a.shape)
    for phase, frames in _frames(scene):
        _enter(model, phase, run, frames[0])
        for frame in frames if frames[0] == 0 else frames[1:]:
            forces[frame] = model.along(run.x[frame], run.v[frame], run.a[frame])[1]
    return forces


def energies(scene: Scene, run: Trajectory) -> dict[str, np.ndarray]:
    """Return the energies of an object, (F,) J each.

    ``kinetic``, ``elastic`` (of the springs, k (a l - L)^2 / 2) and ``gravity`` (0 at the start) are in the object.
    ``work`` is put in by driving devices and loads since the object was at rest, before frame 0, at which driven nodes
    move already. ``dissipated`` is the rest.

    The work of a load is exact. The work of a device is a sum over the frames (trapezoids), exact where the force is
    linear between two frames. Materials that a phase brings keep the forces, not the elastic energy: the difference is
    in ``dissipated``.
    """
    model = Model(scene)
    voigt = run.a * np.linalg.norm(run.x[:, model.j] - run.x[:, model.i], axis=2)
    result = {
        "kinetic": (run.v**2).sum(axis=2) @ scene.mass / 2,
        "elastic": np.zeros(len(run.t)),  # none at the start
        "gravity": -((run.x - run.x[0]) @ scene.gravity) @ scene.mass,
    }
    work = np.full(len(run.t), result["kinetic"][0])
    for phase, frames in _frames(scene):
        _enter(model, phase, run, frames[0])
        result["elastic"][frames[1:]] = (voigt[frames[1:]] - model.L) ** 2 @ model.k / 2
        steady = phase.load * (run.x[frames] - run.x[frames[0]])
        gained, power = _begin(model, phase, run, frames)
        pressed = np.diff(run.t[frames]) * (power[1:] + power[:-1]) / 2
        work[frames[1:]] = work[frames[0]] + gained + steady.sum(axis=(1, 2))[1:] + np.cumsum(pressed)
    inside = sum(result.values())
    return result | {"work": work, "dissipated": work - work[0] - (inside - inside[0])}


def _frames(scene: Scene) -> Iterator[tuple[Phase, np.ndarray]]:
    """Yield each phase with its frames, from the one that it starts at to the one that it ends at."""
    start = 0
    for phase in scene.phases:
        end = start + phase.steps
        yield phase, np.flatnonzero((start <= scene.frames) & (scene.frames <= end))
        start = end


def _enter(model: Model, phase: Phase, run: Trajectory, frame: int) -> None:
    """Give the model the materials that the phase brings, in the state of this frame."""
    if phase.materials:
        _put(model, run, frame)
        model.change_materials(phase.materials)


def _begin(model: Model, phase: Phase, run: Trajectory, frames) -> tuple[float, np.ndarray]:
    """Return the kinetic energy that a phase's constraints put in when it begins, and their power (W) at its frames."""
    power = np.zeros(len(frames))
    for n, frame in enumerate(frames):
        _put(model, run, frame)
        before = model.v.copy()
        model.begin(phase)
        power[n] = (model.reaction() * model.v)[phase.driven].sum()
        if n == 0:
            gained = float(((model.v**2 - before**2).sum(axis=1) @ model.scene.mass) / 2)
    return gained, power


def _put(model: Model, run: Trajectory, frame: int) -> None:
    model.x, model.v, model.a = run.x[frame].copy(), run.v[frame].copy(), run.a[frame].copy()
