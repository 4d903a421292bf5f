"""The integer model compiled to C++: `golden.datapath.machine`, made from the same equations."""

import ctypes
from collections import Counter
from functools import cache
from pathlib import Path

import numpy as np
from numpy.ctypeslib import ndpointer

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.memory_image import MemoryImage
from golden.datapath.rk4 import RK4
from sim.backends.native_build import library
from sim.backends.native_source import sources

PROGRAM = Path(__file__).with_suffix(".cpp")
CHUNK = 1_000_000
"""Edge evaluations per call; Python handles Ctrl-C between two calls."""


@cache
def compiled(fmt: Formats):
    """Return the program ``run`` for these formats, and the names of its faults."""
    files, faults = sources(fmt)
    path = library(files | {PROGRAM.name: PROGRAM.read_text()}, PROGRAM.name)
    run = ctypes.CDLL(str(path)).run
    integers = ndpointer(np.int64, flags="C_CONTIGUOUS")
    run.argtypes = [ctypes.c_int64] * 4 + [integers] * 13
    run.restype = None
    return run, faults


class NativeMachine:
    """The bit-exact model of the circuit, compiled: a `sim.backends.machine.Machine`.

    Raises
    ------
    InputError
        If there is no C++ compiler.
    IndexError
        If the image names a node, a material or a table that it doesn't have.
    """

    def __init__(self, image: MemoryImage):
        self.image, self.faults = image, Counter()
        self.x, self.v, self.ratio = image.x.copy(), image.v.copy(), image.ratio.copy()
        self.force = np.zeros_like(image.x)
        self._run, self._fault_names = compiled(image.formats)
        self._inverse = words(image.inverse, records.inverse_word(image.formats))
        self._damper = words(image.damper, records.damper_word(image.formats))
        self.refresh()

    def restart(self, v: np.ndarray):
        """Go on with these velocities, after changes of the image's materials, loads, masses or edges."""
        self.v = v
        self.refresh()

    def take(self, image: MemoryImage):
        """Go on with an image that differs in materials, natural lengths and ratios."""
        self.image, self.ratio = image, image.ratio.copy()
        self._damper = words(image.damper, records.damper_word(image.formats))
        self.refresh()

    def refresh(self):
        """Take up changes of the image's materials, loads, masses and edges."""
        image, fmt = self.image, self.image.formats
        tables = len(image.damper["rho_value"])
        material = records.material(fmt, tables)
        contents = {name: np.array([m[name] for m in image.materials]) for name in material}
        for what, index, count in (
            ("edges", image.edges, image.nodes),
            ("edge_material", image.edge_material, len(image.materials)),
            ("table", contents["table"], tables),
        ):
            if not np.all((index >= 0) & (index < count)):
                raise IndexError(f"{what} must be 0 to {count - 1}, not {index.min()} to {index.max()}")
        nodes, edges = image.nodes, len(image.edges)
        self._size = nodes, edges, image.velocity_shift
        self._constant = [
            integers(image.load, (nodes, 3)),
            integers(words(image.inverse_mass, records.inverse_mass(fmt)), (nodes, 2)),
            integers(image.edges, (edges, 2)),
            integers(image.edge_material, (edges,)),
            integers(image.length, (edges,)),
            words(contents, material),
            self._inverse,
            self._damper,
        ]

    def step(self, steps: int = 1):
        nodes, edges, _ = self._size
        self.x, self.v, self.force = (integers(s, (nodes, 3)) for s in (self.x, self.v, self.force))
        self.ratio = integers(self.ratio, (edges,))
        state = self.x, self.v, self.ratio, self.force
        chunk = max(1, CHUNK // (RK4.stages * max(edges, 1)))
        for done in range(0, steps, chunk):
            counts = np.zeros(len(self._fault_names), np.int64)
            self._run(min(chunk, steps - done), *self._size, *state, *self._constant, counts)
            self.faults.update({name: int(n) for name, n in zip(self._fault_names, counts, strict=True) if n})


def integers(x, shape) -> np.ndarray:
    """Return a copy of this shape: the compiled program doesn't check its arguments."""
    copy = np.empty(shape, np.int64)
    copy[...] = x
    return copy


def words(contents, record) -> np.ndarray:
    """Return the fields of each record side by side."""
    return np.stack([np.asarray(contents[name], np.int64) for name in record], axis=-1)
