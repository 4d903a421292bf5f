"""Operands for an edge, by the batch: sensible ones, any at all, corners, and exactly on the datapath's boundaries."""

import numpy as np
from edge_model import EdgeModel
from integer_objects import random_raw, random_record

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.datapath.rk4 import RK4
from golden.datapath.tables import damper_table, octave
from golden.numbers.graph import AXES
from golden.numbers.qformat import Q

STEEP = dict(g1=2.0**-7, g2=2.0**-1, rho=lambda g: 1 / (1 + 4 * g), sigma=lambda g: g / (1 + 4 * g))


def damper_tables(rng, fmt: Formats, tables: int) -> dict[str, np.ndarray]:
    """Return one table like a material's, and others of random words."""
    segments = 1 << fmt.damper_index.width
    contents = random_record(rng, records.damper_word(fmt), (tables, segments))
    for name, word in damper_table(fmt, **STEEP).words.items():
        contents[name][0] = word
    return contents


def batch(rng, graph, fmt: Formats, damper, velocity_shift: int, n: int) -> dict[str, np.ndarray]:
    """Return inputs of n edges by name, each (n,) int64: half of them sensible, a quarter anything, a sixteenth powers
    of two and their neighbours, so that results fall on the limits of formats; the rest corners of each format.

    A sixteenth of the edges each then gets its thresholds, its position in the table and its length to lie exactly on
    the boundary between two branches or one step beside it.
    """
    tables = len(damper["rho_value"])
    formats = {name: node.fmt for name, node in graph.inputs.items() if name != "velocity_shift"}
    kind = rng.integers(16, size=n)
    share = {
        number: np.flatnonzero(choice)
        for number, choice in enumerate((kind < 8, (8 <= kind) & (kind < 12), (12 <= kind) & (kind < 15), kind == 15))
    }
    makers = sensible, anything, corners, limits
    inputs = {name: np.empty(n, np.int64) for name in formats}
    for number, rows in share.items():
        for name, values in makers[number](rng, formats, fmt, len(rows)).items():
            inputs[name][rows] = values
    inputs["material_table"] = rng.integers(tables, size=n)
    coincide(rng, inputs, fmt, some(rng, n))

    def model(rows):
        chosen = {name: values[rows] for name, values in inputs.items()}
        return EdgeModel(fmt, graph, damper, chosen | {"velocity_shift": np.int64(velocity_shift)})

    on_limits(rng, inputs, model, fmt, share[3])
    on_boundaries(rng, inputs, model, fmt, rng.permutation(n)[: 3 * n // 16])
    return inputs


def some(rng, n):
    return np.flatnonzero(rng.integers(16, size=n) == 0)


def anything(rng, formats, fmt, n):
    """Return any integers of each format; most shifts are such that a product doesn't vanish."""
    values = {name: rng.integers(q.raw_min, q.raw_max, n, endpoint=True) for name, q in formats.items()}
    return values | shifts(rng, formats, n, 0.7)


def corners(rng, formats, fmt, n):
    return {name: random_raw(rng, q, (n,)) for name, q in formats.items()} | shifts(rng, formats, n, 0.7)


def limits(rng, formats, fmt, n):
    """Return zero, powers of two and the ends of the formats, each with its neighbours."""
    values = {name: near_powers(rng, q, n) for name, q in formats.items()}
    for axis in AXES[1:]:  # most edges along x, whose direction is exact
        along = rng.random(n) < 0.7
        values[f"j_x_{axis}"] = np.where(along, values[f"i_x_{axis}"], values[f"j_x_{axis}"])
    return values | shifts(rng, formats, n, 0.95, low=-3, high=8)


def near_powers(rng, q: Q, n):
    power = np.int64(1) << rng.integers(0, q.width, n)
    power = np.where(rng.random(n) < 0.5, -power, power) + rng.integers(-1, 2, n)
    ends = rng.choice([0, q.raw_min, q.raw_min + 1, q.raw_max - 1, q.raw_max], n)
    return np.clip(np.where(rng.random(n) < 0.2, ends, power), q.raw_min, q.raw_max)


def shifts(rng, formats, n, part, low=-4, high=24):
    """Return exponents: the given part of them between ``low`` and ``high``, the others anywhere."""
    return {
        name: np.where(rng.random(n) < part, rng.integers(low, high, n), rng.integers(q.raw_min, q.raw_max, n))
        for name, q in formats.items()
        if name.endswith("shift")
    }


def sensible(rng, formats, fmt, n):
    """Return edges of an object, in materials with dampers of any kind, in any stage of a step."""
    stage = rng.integers(RK4.stages, size=n)
    values = {f"stage_{bit}": np.array([RK4.stage(s)[bit] for s in range(RK4.stages)])[stage] for bit in RK4.stage(0)}

    direction = rng.normal(size=(n, 3)) * [1, 1, 0] + rng.normal(size=(n, 3)) * [0, 0, 1] * rng.integers(2, size=(n, 1))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    length = 2.0 ** rng.uniform(-8, 0, n)
    speed = 2.0 ** rng.uniform(-14, -1, (n, 1))
    start, velocity = rng.uniform(-0.5, 0.5, (n, 3)), rng.uniform(-1, 1, (n, 3))
    for axis, name in enumerate(AXES):
        values[f"i_x_{name}"] = raw(start[:, axis], fmt.position)
        values[f"j_x_{name}"] = raw((start + direction * length[:, None])[:, axis], fmt.position)
        values[f"i_v_{name}"] = raw((speed * velocity)[:, axis], fmt.velocity)
        values[f"j_v_{name}"] = raw((speed * rng.uniform(-1, 1, (n, 3)))[:, axis], fmt.velocity)

    ratio, strain = rng.uniform(0, 1, n), rng.normal(size=n) * 2.0 ** rng.uniform(-16, -2, n)
    values |= {
        "edge_length": raw(ratio * length * (1 + strain), fmt.length),
        "edge_ratio": raw(ratio, fmt.ratio),
        "edge_base": raw(ratio + rng.normal(size=n) * 2.0**-8, fmt.ratio),
        "edge_total": raw(rng.normal(size=n) * 2.0**-6, fmt.ratio),
        "material_a_min": raw(rng.choice([0, 0.1, 0.4, 1], n), fmt.ratio),
        "material_a_max": raw(rng.choice([0.6, 0.9, 1], n), fmt.ratio),
    }
    for name, q in formats.items():
        if q == fmt.mantissa:
            values[name] = rng.integers(1 << q.width - 1, 1 << q.width, n)
    ranges = {"k": (-10, 2), "c": (-2, 8), "force": (-3, 4), "creep": (-2, 10)}
    for name in formats:
        if name.endswith("shift"):
            low, high = ranges.get(name.removeprefix("material_").removesuffix("_shift"), (0, 6))
            values[name] = rng.integers(low, high, n)
    g1 = 2.0 ** rng.uniform(-12, -1, n) * rng.choice([0, 1], n, p=[0.2, 0.8])
    values["material_g1"] = raw(g1, fmt.threshold)
    values["material_g2"] = raw(np.minimum(g1 * 2.0 ** rng.uniform(0, 4, n), 1.9), fmt.threshold)
    values["material_first_octave"] = raw(octave(np.maximum(g1, 2.0**-fmt.trial_octaves)), fmt.octave)
    values["material_fineness"] = rng.integers(6, 10, n)
    values["material_table"] = np.zeros(n, np.int64)
    return values


def raw(x, q: Q):
    return q.quantise(x, saturate=True)


def coincide(rng, inputs, fmt, rows):
    """Put both ends at the same point, or a few of the finest steps apart."""
    for axis in AXES:
        apart = rng.integers(-2, 3, len(rows)) << rng.choice([0, 0, 0, 8, 14, 16], len(rows))
        end = inputs[f"i_x_{axis}"][rows] + apart
        inputs[f"j_x_{axis}"][rows] = np.clip(end, fmt.position.raw_min, fmt.position.raw_max)


def on_limits(rng, inputs, model, fmt, rows):
    """Choose shifts that nearly cancel: products then lie at the ends of their formats, and some shifts are the first
    that the datapath can't do."""
    spring, relaxed, _ = np.array_split(rows, [len(rows) // 4, len(rows) // 2])
    shifts = model(rows)
    for name, shift in (("k", "stretch_shift"), ("c", "w_shift")):
        inputs[f"material_{name}_shift"][rows] = rng.integers(-1, 4, len(rows)) - shifts[shift]

    # A stretch that is the edge's whole length, a power of two, times a power of two: a force of 1
    inputs["edge_ratio"][spring] = 0
    inputs["edge_length"][spring] = beside(rng, rng.choice([-1, 1], len(spring)) << rng.integers(4, 35, len(spring)))
    shift = rng.integers(0, 2, len(spring))
    inputs["material_k"][spring] = beside(rng, 1 << shift + rng.integers(15, 17, len(spring)))
    inputs["material_k_shift"][spring] = shift - model(spring)["stretch_shift"]

    # An edge of half the positions' range and all of it in the Voigt part: a length of 4
    for axis in AXES[1:]:
        inputs[f"j_x_{axis}"][relaxed] = inputs[f"i_x_{axis}"][relaxed]
    inputs["i_x_x"][relaxed] = beside(rng, np.full(len(relaxed), fmt.position.raw_min // 2))
    inputs["j_x_x"][relaxed] = beside(rng, np.full(len(relaxed), -(fmt.position.raw_min // 2)))
    inputs["edge_ratio"][relaxed] = beside(rng, np.full(len(relaxed), 1 << fmt.ratio.frac_bits))

    shifts = model(rows)
    for name, shift in (("force", "rho_shift"), ("creep", "sigma_shift")):
        total = rng.integers(-1, 2, len(rows)) - shifts["g_shift"] - shifts[shift]
        inputs[f"material_{name}_shift"][rows] = np.clip(total, fmt.exponent.raw_min, fmt.exponent.raw_max)


def beside(rng, values):
    return values + rng.integers(-1, 2, len(values))


def on_boundaries(rng, inputs, model, fmt, rows):
    """Put |g| exactly at a threshold or at the end of a segment, or one step beside it."""
    model, fineness = model(rows), inputs["material_fineness"][rows]
    first, second, third = np.split(np.arange(len(rows)), [len(rows) // 3, 2 * len(rows) // 3])

    at = np.clip(beside(rng, model["size"]), fmt.threshold.raw_min, fmt.threshold.raw_max)
    inputs["material_g1"][rows[first]] = at[first]
    inputs["material_g1"][rows[second]] = at[second] // 2
    inputs["material_g2"][rows[second]] = at[second]

    finest = fmt.octave.frac_bits
    octaves = (model["octave_fraction"] >> fmt.octave_fraction.width - finest) - (model["g_shift"] << finest)
    segment = rng.choice([0, 1, 2, 255, 256, 511, 512], len(rows)) << finest - fineness
    start = np.clip(beside(rng, octaves - segment), fmt.octave.raw_min, fmt.octave.raw_max)
    inputs["material_first_octave"][rows[third]] = start[third]
    inputs["material_g1"][rows[third]] = 0  # so that the table is used
    inputs["material_g2"][rows[third]] = fmt.threshold.raw_max
