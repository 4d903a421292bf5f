"""Largest time step at which Runge-Kutta is stable on an object, and the material that limits it.

Near the shape at rest an edge is linear: with q the change of the Voigt part's length a l,

    f = -rho (k q + c1 ldot)    dq/dt = rho ldot - k sigma q    while a moves freely
                                dq/dt = a ldot                  while a is held by a_min or a_max

and with z = q times a constant both are

    f = -rho c1 ldot - sqrt(kappa) z    dz/dt = sqrt(kappa) ldot - delta z

With the velocities scaled by sqrt(mass), so that ldot = B v, the whole object is

    d/dt [v]   [-B^T rho c1 B   -B^T sqrt(kappa)] [v]
         [z] = [sqrt(kappa) B   -delta          ] [z]

the damping Laplacian, the stiffness Laplacian's square root, and the ratios' own decay. Its numerical range
lies in the left half-plane, and so do its eigenvalues: the step is stable when none of them leaves the
half-disc below.
"""

from __future__ import annotations

from dataclasses import replace
from math import floor, inf, log10
from operator import itemgetter

import numpy as np
from scipy.sparse import block_array, coo_array, csr_array, diags_array
from scipy.sparse.linalg import eigs

from golden.physics.dampers import series
from golden.physics.scene import Scene
from golden.support.errors import InputError

HALF_DISC = 2.6  # |R(z)| <= 1 for |z| <= this and Re z <= 0, R the growth of classical Runge-Kutta in a step
TURNING = 0.8  # margin, because edges turn as the object deforms: pressed to half its height, 1.27 times as fast
DENSE = 30  # up to so many unknowns, all eigenvalues take no longer than one by iteration


def largest_dt(scene: Scene) -> tuple[float, str, str]:
    """Return the largest step (s) that is stable in all phases, the material that limits it, and "stiffness" or
    "damping", the property that does.

    A force-dependent damper is taken both at its stiffest (c_max) and at its softest, the ratios both free and held
    by their bounds. The step is inf when nothing limits it.
    """
    scenes = [replace(scene, materials=materials) for materials in scene.material_sets]
    rate, name, reason = max(
        (_fastest(s, ~held, *law) for s in scenes for held in _held(s) for law in _laws(s)), key=itemgetter(0)
    )
    return (TURNING * HALF_DISC / rate if rate else inf), name, reason


def check(scene: Scene) -> None:
    """Raise `InputError`, naming the material and a step that would do, when the scene's dt is too large."""
    dt, name, reason = largest_dt(scene)
    if scene.dt > dt:
        unit = 10.0 ** (floor(log10(dt)) - 1)
        stable = floor(dt / unit) * unit
        raise InputError(
            f"dt must be at most {stable:.2g} s to be stable, not {scene.dt:g}: "
            f"the {reason} of the material {name!r} on these masses limits it"
        )


def _held(scene: Scene) -> list[np.ndarray]:
    """Return the phases' sets of held nodes, without those that contain another: they are never faster."""
    sets = {phase.held.tobytes(): phase.held for phase in scene.phases}.values()
    return [s for s in sets if not any(o is not s and (o <= s).all() for o in sets)]


def _laws(scene: Scene):
    """Return (rho c1, kappa, delta) per edge for each extreme of the element's behaviour, without duplicates.

    Held by a_min an edge is at its least stiff and its damping at its fastest; held by a_max it is slower
    than that or than with a free ratio. At a_min = 0 no ratio rests: the natural length L pushes it away.
    """
    k, c1 = scene.per_edge(lambda m: m.k), scene.per_edge(lambda m: m.c1)
    a_min, a_max = scene.per_edge(lambda m: m.a_min), scene.per_edge(lambda m: m.a_max)
    laws = {}
    for c2 in (scene.per_edge(lambda m: m.damper.c_max), scene.per_edge(lambda m: m.damper.softest)):
        rho, sigma = series(c1, c2)
        held = rho * c1, rho * k * np.where(a_min > 0, a_min, a_max), np.zeros_like(k)
        moves = a_min < a_max
        free = rho * c1, np.where(moves, rho**2 * k, held[1]), np.where(moves, k * sigma, 0)
        laws |= {np.array(law).tobytes(): law for law in (held, free)}
    return laws.values()


def _fastest(scene: Scene, free, damping, kappa, delta) -> tuple[float, str, str]:
    """Return |eigenvalue| (1/s) of the fastest mode, the material with the largest part in it, and the property."""
    b = _projection(scene, free)
    s = diags_array(np.sqrt(kappa)) @ b
    matrix = csr_array(block_array([[-(b.T @ diags_array(damping) @ b), -s.T], [s, -diags_array(delta)]]))
    rate, mode = _dominant(matrix)
    ldot, z = np.abs(b @ mode[: b.shape[1]]), np.abs(mode[b.shape[1] :])
    by_damping = _per_material(scene, damping * ldot**2)
    by_stiffness = _per_material(scene, 2 * np.sqrt(kappa) * ldot * z + delta * z**2)
    limiting = np.argmax(by_damping + by_stiffness)
    reason = "damping" if by_damping[limiting] >= by_stiffness[limiting] else "stiffness"
    return rate, scene.materials[limiting].name, reason


def _projection(scene: Scene, free) -> csr_array:
    """Return B (E, N dim): from velocities times sqrt(mass) of free nodes to dl/dt of edges, in the initial shape."""
    i, j = scene.mesh.edges.T
    d = scene.mesh.points[j] - scene.mesh.points[i]
    u = d / np.linalg.norm(d, axis=1, keepdims=True)
    scale = np.where(free, 1 / np.sqrt(scene.mass), 0)[:, None]
    rows = np.repeat(np.arange(len(d)), scene.dim)
    columns = np.arange(scene.mesh.points.size).reshape(-1, scene.dim)
    entries = np.concatenate([u * scale[j], -u * scale[i]]).ravel()
    at = np.tile(rows, 2), np.concatenate([columns[j], columns[i]]).ravel()
    return csr_array(coo_array((entries, at), shape=(len(d), scene.mesh.points.size)))


def _dominant(matrix: csr_array) -> tuple[float, np.ndarray]:
    """Return the largest |eigenvalue| and its vector."""
    n = matrix.shape[0]
    if not matrix.count_nonzero():
        return 0.0, np.zeros(n)
    if n <= DENSE:
        values, vectors = np.linalg.eig(matrix.toarray())
    else:
        values, vectors = eigs(matrix, k=1, tol=1e-4, v0=np.random.default_rng(0).standard_normal(n))
    largest = np.argmax(np.abs(values))
    return float(np.abs(values[largest])), vectors[:, largest]


def _per_material(scene: Scene, value) -> np.ndarray:
    return np.bincount(scene.edge_material, value, len(scene.materials))
