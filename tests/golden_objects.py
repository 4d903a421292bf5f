"""Small objects and phases for the tests of the float64 model."""

import numpy as np

from golden.mesh.mesh import Mesh
from golden.physics.materials import Material
from golden.physics.scene import Phase, Scene


def line(length=1.0) -> Mesh:
    """Return one edge along x."""
    return Mesh(np.array([[0.0, 0.0], [length, 0.0]]), np.empty((0, 3), dtype=int), np.array([[0, 1]]))


def phase(mesh, steps, fixed=(), driven=None, load=None, name="phase") -> Phase:
    """Return a phase; ``fixed``: node indices or a mask, ``driven``: (nodes, velocity), ``load``: (nodes, force)."""
    shape = mesh.points.shape
    hold, drive = np.zeros(shape[0], bool), np.zeros(shape[0], bool)
    velocity, force = np.zeros(shape), np.zeros(shape)
    hold[np.asarray(fixed, dtype=None if len(fixed) else int)] = True
    if driven:
        drive[driven[0]], velocity[driven[0]] = True, driven[1]
    if load:
        force[load[0]] = load[1]
    return Phase(name, steps, hold, velocity, drive, force)


def scene(mesh, materials, dt, phases, mass=1.0, gravity=None, edge_material=0, every=None):
    """Return a scene; ``mass``: each node's or (N,); ``every``: steps between frames, else only the ends of phases."""
    materials = (materials,) if isinstance(materials, Material) else tuple(materials)
    ends = np.cumsum([p.steps for p in phases])
    frames = np.union1d([0, *ends], np.arange(0, ends[-1] + 1, every or ends[-1]))
    return Scene(
        name="object",
        description="",
        path=None,
        mesh=mesh,
        materials=materials,
        edge_material=np.broadcast_to(edge_material, len(mesh.edges)),
        mass=np.broadcast_to(np.asarray(mass, dtype=float), len(mesh.points)),
        gravity=np.zeros(mesh.dim) if gravity is None else np.asarray(gravity, dtype=float),
        dt=dt,
        phases=tuple(phases),
        frames=frames,
    )


def bottom(mesh) -> np.ndarray:
    """Return the mask of the nodes on the lowest level of the last axis."""
    return mesh.points[:, -1] == mesh.points[:, -1].min()


def top(mesh) -> np.ndarray:
    """Return the mask of the nodes on the highest level of the last axis."""
    return mesh.points[:, -1] == mesh.points[:, -1].max()


def press_hold_release(mesh, depth, press, hold, release) -> list[Phase]:
    """Return three phases on a fixed bottom: the top goes down ``depth`` (m) in (steps, dt), is held, is let go."""
    steps, dt = press
    down = np.zeros(mesh.dim)
    down[-1] = -depth / (steps * dt)
    return [
        phase(mesh, steps, bottom(mesh), (top(mesh), down), name="press"),
        phase(mesh, hold, bottom(mesh) | top(mesh), name="hold"),
        phase(mesh, release, bottom(mesh), name="release"),
    ]
