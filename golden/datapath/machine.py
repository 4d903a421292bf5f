"""A whole step in integers: what the circuit computes, bit for bit, on NumPy arrays."""

from collections import Counter
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np

from golden.datapath import records
from golden.datapath.edge import edge
from golden.datapath.memory_image import MemoryImage
from golden.datapath.node import node
from golden.datapath.rk4 import RK4
from golden.datapath.tables import Tables
from golden.numbers.qarray import QArray
from golden.numbers.qformat import BIT


class Machine:
    """The bit-exact model of the circuit, loaded with a `MemoryImage`.

    Parameters
    ----------
    watch : callable, optional
        Called in each stage with the quantities of `golden.datapath.edge.edge`, then with those of
        `golden.datapath.node.node`. It must not change them.

    Attributes
    ----------
    x, v : (N, 3) int64
        Positions and velocities at the last step boundary.
    ratio : (E,) int64
    force : (N, 3) int64
        Edge forces and load on each node in the last stage.
    faults : Counter
        How often each quantity saturated (or an edge became too short), by name.
    """

    def __init__(self, image: MemoryImage, watch: Callable[[dict], object] | None = None):
        self.image, self.faults, self._watch = image, Counter(), watch
        self._fmt = image.formats
        self._tables = Tables(self._fmt, image.inverse, image.damper)
        self._stages = [
            SimpleNamespace(**{name: self._number(np.int64(bit), BIT) for name, bit in RK4.stage(s).items()})
            for s in range(RK4.stages)
        ]
        self.x, self.v, self.ratio = image.x.copy(), image.v.copy(), image.ratio.copy()
        self.force = np.zeros_like(image.x)
        self.refresh()

    def restart(self, v: np.ndarray):
        """Go on with these velocities, and take up the image's changes."""
        self.v = v
        self.refresh()

    def take(self, image: MemoryImage):
        """Go on with an image that differs in materials, natural lengths and ratios."""
        self.image, self.ratio = image, image.ratio.copy()
        self._tables = Tables(self._fmt, image.inverse, image.damper)
        self.refresh()

    def refresh(self):
        """Take up changes of the image's materials, loads, masses and edges."""
        image, fmt = self.image, self._fmt
        record = records.material(fmt, len(image.damper["rho_value"]))
        contents = {name: np.array([m[name] for m in image.materials], np.int64) for name in record}
        self._material = self._record(record, {name: c[image.edge_material] for name, c in contents.items()})
        self._length = self._number(image.length, fmt.length)
        self._load = self._vector(image.load, fmt.accumulator)
        self._inverse_mass = self._record(records.inverse_mass(fmt), image.inverse_mass)
        self._shift = self._number(np.int64(image.velocity_shift), fmt.exponent)

    def _number(self, raw, fmt):
        return QArray(raw, fmt, self.faults)

    def _vector(self, raw, fmt):
        return [self._number(np.ascontiguousarray(column), fmt) for column in raw.T]

    def _record(self, record, raw):
        return SimpleNamespace(**{name: self._number(raw[name], q) for name, q in record.items()})

    def step(self, steps: int = 1):
        for _ in range(steps):
            self._step()

    def _step(self):
        fmt, ends = self._fmt, self.image.edges.T
        x = x_base = self._vector(self.x, fmt.position)
        v = v_base = self._vector(self.v, fmt.velocity)
        x_total, v_total = (self._vector(np.zeros_like(self.x), q) for q in (fmt.displacement, fmt.velocity))
        base = ratio = self._number(self.ratio, fmt.ratio)
        total = self._number(np.zeros_like(self.ratio), fmt.ratio)
        for stage in self._stages:
            state = SimpleNamespace(base=base, ratio=ratio, total=total, length=self._length)
            i, j = (SimpleNamespace(x=take(x, end), v=take(v, end)) for end in ends)
            e = edge(fmt, self._tables, stage, self._shift, self._material, i, j, state)
            base, ratio, total = e["base_next"], e["ratio_next"], e["total_next"]
            pulls = [self._number(accumulate(len(self.x), ends, pull.raw), fmt.accumulator) for pull in e["pull"]]
            state = SimpleNamespace(x_base=x_base, v_base=v_base, v=v, x_total=x_total, v_total=v_total)
            n = node(fmt, stage, self._shift, [pulls], self._load, self._inverse_mass, state)
            if self._watch:
                self._watch(e)
                self._watch(n)
            x, v, x_base, v_base = n["x"], n["v"], n["x_base_next"], n["v_base_next"]
            x_total, v_total = n["x_total"], n["v_total"]
        self.x, self.v, self.force = (np.stack([c.raw for c in vector], 1) for vector in (x, v, n["force"]))
        self.ratio = ratio.raw


def take(vector, index):
    """Return the vectors of the nodes ``index``."""
    return [QArray(c.raw[index], c.fmt, c.faults) for c in vector]


def accumulate(nodes: int, ends, pull):
    """Return the sum over edges: ``pull`` on the first end, the same integers with the opposite sign on the second."""
    forces = np.zeros(nodes, np.int64)
    np.add.at(forces, ends[0], pull)
    np.subtract.at(forces, ends[1], pull)
    return forces
