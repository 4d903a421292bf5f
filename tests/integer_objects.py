"""Small objects for the tests of the integer model: realistic ones of every preset, and images of random integers."""

import numpy as np
from golden_objects import phase, scene

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.memory_image import MemoryImage
from golden.mesh.mesh import Mesh, box, rectangle
from golden.numbers.qformat import Q
from golden.physics.materials import PRESETS

FORCE = dict(f1=0.05, f2=0.5)
MATERIALS = {
    "viscoelastic": PRESETS["viscoelastic"]("viscoelastic", 200.0, 0.5),
    "plastic": PRESETS["plastic"]("plastic", 2.0),
    "rheological": PRESETS["rheological"]("rheological", 200.0, 0.5, 20.0),
    "rheological-force": PRESETS["rheological-force"](
        "rheological-force", 200.0, 0.5, **FORCE, c_max=200.0, c_min=2.0, a_min=0.1, a_max=0.9
    ),
    "plastic-force": PRESETS["plastic-force"]("plastic-force", 5.0, **FORCE, c_max=1.0, c_min=0.05),
}
DT = 2e-4  # s
SPACING = 0.0125  # m


def irregular(nodes, rng) -> Mesh:
    """Return a grid with so many nodes an axis, each moved at random near its place."""
    grid = (rectangle if len(nodes) == 2 else box)(nodes, tuple(SPACING * (n - 1) for n in nodes))
    return Mesh(grid.points + rng.uniform(-0.15, 0.15, grid.points.shape) * SPACING, grid.cells, grid.edges)


def pressed(mesh, materials, steps, depth=0.05, edge_material=0, let_go=1):
    """Return a scene: pressed by part of its size for a third of the steps, held for a third, let go for ``let_go``
    thirds."""
    low, high = mesh.points[:, -1] < SPACING / 2, mesh.points[:, -1] > mesh.points[:, -1].max() - SPACING / 2
    third = steps // 3
    down = np.zeros(mesh.dim)
    down[-1] = -depth * mesh.size / (third * DT)
    phases = [
        phase(mesh, third, low, (high, down), name="press"),
        phase(mesh, third, low | high, name="hold"),
        phase(mesh, third * let_go, low, name="release"),
    ]
    return scene(mesh, materials, DT, phases, mass=0.002, edge_material=edge_material)


def random_raw(rng, q: Q, shape=()):
    """Return integers of a format: half of them anywhere, a quarter small, a quarter at its ends and around zero."""
    anywhere = rng.integers(q.raw_min, q.raw_max, shape, endpoint=True)
    small = anywhere >> rng.integers(0, q.width, shape)
    corners = [c for c in (q.raw_min, q.raw_min + 1, -1, 0, 1, q.raw_max - 1, q.raw_max) if c >= q.raw_min]
    choice = rng.integers(4, size=shape)
    return np.where(choice < 2, anywhere, np.where(choice == 2, small, rng.choice(corners, shape)))


def random_record(rng, record: dict[str, Q], shape=()):
    return {name: random_raw(rng, q, shape) for name, q in record.items()}


def random_image(rng, fmt=None, nodes=12, edges=60, materials=8, tables=3, true_inverse=True) -> MemoryImage:
    """Return an image that the circuit accepts and no scene makes: nearly everything in it saturates something.

    Unless ``true_inverse``, its table of 1 / sqrt(q) is random as well, half of it as large as possible.
    """
    fmt = fmt or Formats()
    ends = rng.integers(nodes, size=(edges, 2))
    ends[:, 1] = (ends[:, 0] + rng.integers(1, nodes, edges)) % nodes
    contents = [random_record(rng, records.material(fmt, tables)) for _ in range(materials)]
    for material in contents:
        material["table"] = rng.integers(tables)
        for name in material:  # shifts that make something of the product, more often than not
            if name.endswith("shift") and rng.random() < 0.6:
                material[name] = rng.integers(-4, 24)
    image = MemoryImage(
        formats=fmt,
        velocity_shift=int(rng.integers(0, 20)),
        x=random_raw(rng, fmt.position, (nodes, 3)),
        v=random_raw(rng, fmt.velocity, (nodes, 3)),
        load=random_raw(rng, fmt.accumulator, (nodes, 3)),
        inverse_mass=random_record(rng, records.inverse_mass(fmt), (nodes,)),
        edges=ends,
        edge_material=rng.integers(materials, size=edges),
        length=random_raw(rng, fmt.length, (edges,)),
        ratio=random_raw(rng, fmt.ratio, (edges,)),
        materials=[{name: int(raw) for name, raw in material.items()} for material in contents],
        damper=random_record(rng, records.damper_word(fmt), (tables, 1 << fmt.damper_index.width)),
    )
    image.x[0] = image.x[1]  # edges of no length
    if not true_inverse:
        word = records.inverse_word(fmt)
        entries = 1 << fmt.inverse_index.width
        large = rng.integers(2, size=entries)
        image.inverse = random_record(rng, word, (entries,))
        image.inverse["value"] = np.where(large, word["value"].raw_max, image.inverse["value"])
    return image
