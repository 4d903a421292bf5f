"""Encode a scene as the integers that a circuit is loaded with, and decode the circuit's integers to SI."""

from dataclasses import dataclass

import numpy as np

from golden.datapath import records
from golden.datapath.edge import axis_of, voigt_length
from golden.datapath.formats import Formats
from golden.datapath.memory_image import MemoryImage
from golden.datapath.tables import Tables
from golden.numbers.qarray import QArray
from golden.numbers.qformat import Q
from golden.physics.materials import Material
from golden.physics.scene import Phase, Scene
from sim.encode.coefficients import coefficient, coefficients
from sim.encode.order import order, ranks
from sim.encode.units import Units, choose


@dataclass(frozen=True, eq=False)
class EncodedScene:
    """A scene in the circuit's numbers.

    ``image`` counts nodes and edges in the circuit's order: its node n is the scene's ``node_order[n]``, its edge e
    the scene's ``edge_order[e]``.
    """

    scene: Scene
    units: Units
    image: MemoryImage
    node_order: np.ndarray
    edge_order: np.ndarray

    def start(self, phase: Phase, v: np.ndarray) -> np.ndarray:
        """Set loads and masses of a phase in the image; return the velocities ``v`` (raw) with those of held nodes
        replaced."""
        scene, units, fmt = self.scene, self.units, self.image.formats
        weight = scene.mass[:, None] * scene.gravity
        self.image.load = raw_vectors((phase.load + weight)[self.node_order] / units.force, fmt.accumulator)
        self.image.inverse_mass = inverse_mass(np.where(phase.held, np.inf, scene.mass)[self.node_order], units, fmt)
        velocity = np.where(phase.driven[:, None], phase.velocity, 0.0) / units.velocity
        prescribed = raw_vectors(velocity[self.node_order], fmt.velocity)
        return np.where(phase.held[self.node_order, None], prescribed, v)

    def node_values(self, raw: np.ndarray, q: Q) -> np.ndarray:
        """Return (N, dim) float64 in the scene's order from (N, 3) integers in the circuit's."""
        values = np.empty((len(raw), self.scene.dim))
        values[self.node_order] = q.to_float(raw[:, : self.scene.dim])
        return values

    def positions(self, raw):
        """Return (N, dim) positions (m)."""
        return self.node_values(raw, self.image.formats.position) * self.units.size + self.units.centre

    def velocities(self, raw):
        """Return (N, dim) velocities (m/s)."""
        return self.node_values(raw, self.image.formats.velocity) * self.units.velocity

    def forces(self, raw):
        """Return (N, dim) forces (N)."""
        return self.node_values(raw, self.image.formats.accumulator) * self.units.force

    def ratios(self, raw):
        """Return (E,) ratios."""
        values = np.empty(len(raw))
        values[self.edge_order] = self.image.formats.ratio.to_float(raw)
        return values


def raw_vectors(values: np.ndarray, q: Q) -> np.ndarray:
    """Return (N, 3) integers, rounded half up, of (N, dim) values in the format's unit.

    Raises ValueError if one doesn't fit.
    """
    padded = np.zeros((len(values), 3))
    padded[:, : values.shape[1]] = values
    return q.quantise(padded)


def inverse_mass(mass: np.ndarray, units: Units, formats: Formats) -> dict[str, np.ndarray]:
    """Return the velocity gained per step and force, for `golden.datapath.node`; an infinite mass (kg) gives 0."""
    scale = units.force * units.dt / units.velocity * 2.0 ** (formats.accumulator.int_bits - 1)
    values, shifts = zip(*(coefficient(scale / m, formats) for m in mass), strict=True)
    return {"value": np.array(values, np.int64), "shift": np.array(shifts, np.int64)}


def encode(scene: Scene, formats: Formats | None = None, *, edge_order: np.ndarray | None = None) -> EncodedScene:
    """Return a scene in the circuit's numbers, at the start of its first phase.

    Parameters
    ----------
    edge_order
        (E,) permutation to use instead of the fast one; the results are the same.

    Raises
    ------
    InputError
        If a number of the scene cannot be represented.
    """
    formats = formats or Formats()
    units = choose(scene, formats)
    node_order, sorted_edges = order(scene.mesh.points, scene.mesh.edges)
    edge_order = sorted_edges if edge_order is None else edge_order
    edges = np.sort(ranks(node_order)[scene.mesh.edges[edge_order]], axis=1)

    materials, damper = encode_materials(scene.materials, units, formats)
    x = raw_vectors((scene.mesh.points[node_order] - units.centre) / units.size, formats.position)
    a0 = formats.ratio.quantise([m.a0 for m in scene.materials])[scene.edge_material[edge_order]]
    image = MemoryImage(
        formats=formats,
        velocity_shift=units.velocity_shift,
        x=x,
        v=np.zeros_like(x),
        load=np.zeros_like(x),
        inverse_mass={},
        edges=edges,
        edge_material=scene.edge_material[edge_order],
        length=np.zeros(len(edges), np.int64),
        ratio=a0,
        materials=materials,
        damper=damper,
    )
    image.length = natural_length(image)
    encoded = EncodedScene(scene, units, image, node_order, edge_order)
    image.v = encoded.start(scene.phases[0], image.v)
    return encoded


def encode_materials(materials: tuple[Material, ...], units: Units, formats: Formats):
    """Return an image's ``materials`` and ``damper``."""
    fields, tables = [], []
    for number, material in enumerate(materials):
        record, table = coefficients(material, number, units, formats, len(tables))
        fields.append(record)
        tables += [table.words] if table else []
    return fields, stack(tables, formats)


def stack(tables: list[dict[str, np.ndarray]], formats: Formats) -> dict[str, np.ndarray]:
    """Return (T, segments) for each field; one table of zeros where no damper needs any."""
    blank = {name: np.zeros(1 << formats.damper_index.width, np.int64) for name in records.damper_word(formats)}
    return {name: np.stack([t[name] for t in tables or [blank]]) for name in blank}


def natural_length(image: MemoryImage) -> np.ndarray:
    """Return (E,) L = a0 l from the datapath's own product: an object at rest is at rest in the integers too."""
    fmt = image.formats
    tables = Tables(fmt, image.inverse, image.damper)

    def number(raw, q):
        return QArray(raw, q, None)

    i, j = ([number(column, fmt.position) for column in image.x[end].T] for end in image.edges.T)
    axis = axis_of(fmt, tables, i, j)
    share = number(image.ratio, fmt.ratio).to(fmt.share)
    return voigt_length(fmt, share, axis).raw
