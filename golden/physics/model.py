"""The float64 model: equations (1) to (5) and (7) on edges, Newton's law on nodes, Runge-Kutta in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from golden.physics.materials import Material
from golden.physics.scene import Phase, Scene
from golden.physics.switch import switch_material
from golden.physics.trajectory import Trajectory
from golden.support.errors import InputError

REPORT_EVERY = 200  # steps between two calls of ``progress``


class Model:
    """An object of N nodes and E edges in motion: positions x and velocities v (N, dim), ratios a (E,).

    SI units. It starts at rest, free of stress, under the constraints and loads of the scene's first phase.
    """

    def __init__(self, scene: Scene):
        self.i, self.j = scene.mesh.edges.T
        self._use_materials(scene)
        ends = np.concatenate([self.j, self.i])[:, None]
        self.component = (ends * scene.dim + np.arange(scene.dim)).ravel()  # where +f u, then -f u, are added

        self.x, self.v = scene.mesh.points.copy(), np.zeros_like(scene.mesh.points)
        self.a = scene.per_edge(lambda m: m.a0)
        self.L = self.a * norm(self.x[self.j] - self.x[self.i])
        self.begin(scene.phases[0])

    def _use_materials(self, scene: Scene) -> None:
        """Take the scene's materials."""
        self.scene = scene
        self.k, self.c1 = scene.per_edge(lambda m: m.k), scene.per_edge(lambda m: m.c1)
        self.a_min, self.a_max = scene.per_edge(lambda m: m.a_min), scene.per_edge(lambda m: m.a_max)
        self.rho, self.sigma = scene.per_edge(lambda m: m.rho_sigma(0)[0]), scene.per_edge(lambda m: m.rho_sigma(0)[1])
        self.varying = [  # (material, its edges) whose damper depends on the force
            (material, np.flatnonzero(scene.edge_material == number))
            for number, material in enumerate(scene.materials)
            if material.damper.force_dependent
        ]

    def change_materials(self, materials: tuple[Material, ...]) -> None:
        """Replace the materials, one for each there was, without a jump in force: `golden.physics.switch`."""
        _, length, rate = self.edge_motion(self.x, self.v)
        for number, (old, new) in enumerate(zip(self.scene.materials, materials, strict=True)):
            here = self.scene.edge_material == number
            if old != new:
                state = (part[here] for part in (length, rate, self.a, self.L))
                self.a[here], self.L[here] = switch_material(old, new, *state)
        self._use_materials(replace(self.scene, materials=materials))

    def begin(self, phase: Phase) -> None:
        """Put the object under a phase's constraints and loads."""
        mass = self.scene.mass[:, None]
        self.held = phase.held[:, None]
        self.mobility = np.where(self.held, 0, 1 / mass)
        self.external = phase.load + mass * self.scene.gravity
        self.v[phase.fixed] = 0
        self.v[phase.driven] = phase.velocity[phase.driven]

    def edge_law(self, length, ldot, a):
        """Return f (N, > 0 pushes the ends apart) and da/dt (1/s) of the edges, equations (1) to (3) and (7).

        Equal forces in the Voigt part and in the damper give f = -rho g and the rate s = sigma g at which the
        damper part, of length (1 - a) l, extends; the latter gives da/dt.
        """
        g = self.k * (a * length - self.L) + self.c1 * ldot
        sigma, rho = self.sigma, self.rho
        if self.varying:
            sigma, rho = sigma.copy(), rho.copy()
        for material, edges in self.varying:
            rho[edges], sigma[edges] = material.rho_sigma(g[edges])
        return -rho * g, ((1 - a) * ldot - sigma * g) / length

    def edge_motion(self, x, v):
        """Return the edges' directions (E, dim), lengths (E,) and dl/dt (E,)."""
        d = x[self.j] - x[self.i]
        length = norm(d)
        u = d / length[:, None]
        return u, length, dot(u, v[self.j] - v[self.i])

    def along(self, x, v, a):
        """Return the edges' directions (E, dim), and f (E,) and da/dt (E,) as `edge_law` has them."""
        u, length, rate = self.edge_motion(x, v)
        return u, *self.edge_law(length, rate, a)

    def edges(self, x, v, a):
        """Return the sum of the edges' forces on each node (N, dim), and da/dt (E,)."""
        u, f, a_rate = self.along(x, v, a)
        push = (f[:, None] * u).ravel()
        force = np.bincount(self.component, np.concatenate([push, -push]), x.size)
        return force.reshape(x.shape), a_rate

    def rates(self, x, v, a):
        """Return the time derivatives of positions, velocities and ratios."""
        force, a_rate = self.edges(x, v, a)
        return v, self.mobility * (force + self.external), a_rate

    def advanced(self, rates, time):
        """Return the state after ``time`` at these rates, the ratios clamped to [a_min, a_max]: equation (5)."""
        x_rate, v_rate, a_rate = rates
        a = np.minimum(np.maximum(self.a + time * a_rate, self.a_min), self.a_max)
        return self.x + time * x_rate, self.v + time * v_rate, a

    def step(self) -> None:
        """Take one step of classical fourth-order Runge-Kutta."""
        dt = self.scene.dt
        k1 = self.rates(self.x, self.v, self.a)
        k2 = self.rates(*self.advanced(k1, dt / 2))
        k3 = self.rates(*self.advanced(k2, dt / 2))
        k4 = self.rates(*self.advanced(k3, dt))
        mean = [(r1 + 2 * (r2 + r3) + r4) / 6 for r1, r2, r3, r4 in zip(k1, k2, k3, k4, strict=True)]
        self.x, self.v, self.a = self.advanced(mean, dt)

    def reaction(self) -> np.ndarray:
        """Return the forces (N, dim) of supports and driving devices on fixed and driven nodes, 0 on free ones (N)."""
        force, _ = self.edges(self.x, self.v, self.a)
        return np.where(self.held, -(force + self.external), 0)


def simulate(scene: Scene, progress: Callable[[int], object] | None = None) -> Trajectory:
    """Run the scene through its phases and keep its frames; ``progress(steps done)`` is called every 200 steps.

    The time step is not checked here: `golden.physics.stability.check` does that. Raises `InputError` when the state
    is no longer finite.
    """
    model = Model(scene)
    wanted = set(scene.frames.tolist())
    kept = [_frame(model, 0)]
    done = 0
    with np.errstate(all="ignore"):
        for phase in scene.phases:
            if phase.materials:
                model.change_materials(phase.materials)
            model.begin(phase)
            for _ in range(phase.steps):
                model.step()
                done += 1
                if done in wanted:
                    kept.append(_frame(model, done))
                if done % REPORT_EVERY == 0 or done in wanted:
                    if not all(np.isfinite(s).all() for s in (model.x, model.v, model.a)):
                        raise InputError(
                            f"dt must be small enough for a finite state, not {scene.dt:g}: "
                            f"lost by step {done} in phase {phase.name!r}"
                        )
                    if progress:
                        progress(done)
    t, x, v, a, reaction = map(np.array, zip(*kept, strict=True))
    return Trajectory(t, x, v, a, reaction, scene.mesh.edges)


def _frame(model: Model, step: int):
    return step * model.scene.dt, model.x.copy(), model.v.copy(), model.a.copy(), model.reaction()


def dot(p, q) -> np.ndarray:
    """Return the dot product of each pair of rows."""
    return np.einsum("ij,ij->i", p, q)


def norm(d) -> np.ndarray:
    """Return the length of each row."""
    return np.sqrt(dot(d, d))
