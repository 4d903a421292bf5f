"""The page's data in few bytes: whole numbers in base64, each array with the step that it is a multiple of."""

from __future__ import annotations

from base64 import b64encode

import numpy as np

from golden.datapath.formats import Formats
from golden.physics.scene import Scene
from sim.report.surface import outline, surface
from sim.results import energy
from sim.results.comparison import BOUND, Comparison
from sim.results.face import watched

BUDGET = 800_000  # bytes of a scene's frames before base64 makes them a third longer
MOST = 240  # frames drawn of a scene
COLOURED = 0.995  # part of the forces, or of the ratios from each end, that lies within its colour scale
DIGITS = 6  # of a number in a curve


def scene(comparison: Comparison) -> dict:
    """Return one scene for JSON: the mesh, the drawn frames and the curves of all frames."""
    of = comparison.scene
    mesh, faces = of.mesh, surface(of.mesh)
    frames = frames_to_draw(of)
    float64, circuit = comparison.float64.trajectory, comparison.circuit.trajectory
    apart = (circuit.x - float64.x)[frames]
    force = [energy.edge_forces(of, run)[frames] for run in (float64, circuit)]
    ratio = [run.a[frames] for run in (float64, circuit)]
    largest = float(np.quantile(np.abs(force), COLOURED))
    return {
        "name": of.name,
        "dim": of.dim,
        "size": of.size,
        "circuit": comparison.circuit.backend,
        "phases": [{"name": phase.name, "end": float(end)} for phase, end in zip(of.phases, _ends(of), strict=True)],
        "held": [
            {"fixed": np.flatnonzero(phase.fixed).tolist(), "driven": np.flatnonzero(phase.driven).tolist()}
            for phase in of.phases
        ],
        "nodes": len(mesh.points),
        "frames": frames.tolist(),
        "edges": packed(mesh.edges.ravel(), "<u2"),
        "faces": packed(faces.ravel(), "<u2"),
        "outline": rounded(outline(mesh).ravel()),
        "x": quantised(float64.x[frames], 16),
        "apart": centred(apart, 16),
        "ratio": dict(zip(("float64", "circuit"), together(ratio, *ratio_limits(ratio)), strict=True)),
        "force": dict(zip(("float64", "circuit"), together(force, -largest, largest), strict=True)),
        "largest_apart": float(np.linalg.norm(apart, axis=2).max()),
        "curves": curves(comparison),
    }


def frames_to_draw(of: Scene) -> np.ndarray:
    """Return the frames to draw: all of them if there is room, and the ends of the phases in any case."""
    each = 4 * of.mesh.points.size + 4 * len(of.mesh.edges)
    room = max(2 * len(of.phases), min(MOST, BUDGET // each))
    count = len(of.frames)
    wanted = np.linspace(0, count - 1, min(count, room)).round().astype(int)
    return np.union1d(wanted, of.end_frames)


def curves(comparison: Comparison) -> dict:
    """Return the curves in SI units, each a list with a number for every frame."""
    of, face = comparison.scene, watched(comparison.scene)
    float64, circuit = comparison.float64.trajectory, comparison.circuit.trajectory
    return {
        "t": rounded(circuit.t),
        "dx_rel": rounded(comparison.dx_rel()),
        "bound": BOUND[of.force_dependent],
        "last_bit": Formats().position.lsb,
        "face": {"name": face.name, "pressed": face.pressed, "axis": "xyz"[face.axis]},
        "force": {"float64": rounded(face.force(float64)), "circuit": rounded(face.force(circuit))},
        "height": {"float64": rounded(face.height(float64)), "circuit": rounded(face.height(circuit))},
        "energy": {name: rounded(values) for name, values in comparison.energy.items()},
    }


def ratio_limits(ratios: list[np.ndarray]) -> tuple[float, float]:
    """Return the ends of a scale of ratios: hundredths around most of them, at least a tenth apart."""
    low, high = np.quantile(np.concatenate([ratio.ravel() for ratio in ratios]), (1 - COLOURED, COLOURED))
    low, high = np.floor(low * 100) / 100, np.ceil(high * 100) / 100
    if high - low < 0.1:
        middle = np.clip(round((low + high) / 2, 2), 0.05, 0.95)
        low, high = middle - 0.05, middle + 0.05
    return float(low), float(high)


def quantised(values: np.ndarray, bits: int) -> dict:
    """Pack (F, N, dim) as unsigned integers over their bounding box: on each axis value = low + step * integer."""
    low, high = values.min(axis=(0, 1)), values.max(axis=(0, 1))
    step = np.where(high > low, (high - low) / ((1 << bits) - 1), 1.0)
    integers = np.rint((values - low) / step)
    return {"low": low.tolist(), "step": step.tolist(), "data": packed(integers, f"<u{bits // 8}")}


def centred(values: np.ndarray, bits: int) -> dict:
    """Pack values around 0 as signed integers: value = step * integer, however small the values are."""
    step = float(np.abs(values).max()) / ((1 << bits - 1) - 1) or 1.0
    return {"step": step, "data": packed(np.rint(values / step), f"<i{bits // 8}")}


def together(arrays: list[np.ndarray], low: float, high: float) -> list[dict]:
    """Pack arrays on one colour scale: value = low + (high - low) * integer / 255; values beyond it are at its ends."""
    width = high - low or 1.0
    return [
        {"low": low, "high": high, "data": packed(np.rint((values.clip(low, high) - low) / width * 255), "u1")}
        for values in arrays
    ]


def packed(integers: np.ndarray, kind: str) -> str:
    return b64encode(np.asarray(integers).astype(kind).tobytes()).decode()


def rounded(values: np.ndarray) -> list[float | None]:
    """Return numbers for JSON, rounded to `DIGITS` digits; NaN becomes null."""
    return [float(f"{value:.{DIGITS}g}") if np.isfinite(value) else None for value in values]


def _ends(of: Scene) -> np.ndarray:
    return np.cumsum([phase.steps for phase in of.phases]) * of.dt
