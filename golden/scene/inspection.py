"""Figures of a mesh before it is run: size, worst element, stable steps, the boards that hold it."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite

import numpy as np

from golden.datapath.formats import Formats
from golden.mesh.mesh import Mesh
from golden.physics import stability
from golden.physics.scene import Phase, Scene
from golden.scene import capacity
from golden.support.errors import InputError


def inspect(mesh: Mesh, materials_from: Scene | None = None) -> dict:
    """Return the figures of a mesh, ready for JSON: SI units, nodes and elements by their index from 0.

    ``materials_from`` is a scene whose materials and density are tried out on the mesh. Raises `InputError` when it has
    another dimension.
    """
    quality, lengths = mesh.quality(), mesh.lengths()
    worst, shortest = int(np.argmin(quality)), int(np.argmin(lengths))
    meeting = np.bincount(mesh.edges.ravel())
    return {
        "dim": mesh.dim,
        "nodes": len(mesh.points),
        "edges": len(mesh.edges),
        "elements": len(mesh.cells),
        "parts": int(mesh.components()[0]),
        "extent": {"min": mesh.points.min(axis=0).tolist(), "max": mesh.points.max(axis=0).tolist()},
        "measure": float(mesh.measure().sum()),
        "edge_length": {
            "min": float(lengths[shortest]),
            "max": float(lengths.max()),
            "shortest": mesh.edges[shortest].tolist(),
        },
        "radius_ratio": {
            "min": float(quality[worst]),
            "mean": float(quality.mean()),
            "worst_element": worst,
            "nodes": mesh.cells[worst].tolist(),
        },
        "most_edges_at_a_node": {
            "edges": int(meeting.max()),
            "node": int(np.argmax(meeting)),
            "allowed": capacity.max_edges_at_node(Formats()),
        },
        "stable_dt": materials_from and stable_dt(mesh, materials_from),
        "boards": {
            board.board: {"fits": not board.shortfall(mesh), "too_many": board.shortfall(mesh)}
            for board in capacity.load_capacities()
        },
    }


def stable_dt(mesh: Mesh, scene: Scene) -> dict[str, float | None]:
    """Return for each material of the scene the largest stable step (s) of the free mesh made of it alone.

    The density is the scene's mean. None stands for no limit. Raises `InputError` for a scene of another dimension.
    """
    if scene.dim != mesh.dim:
        raise InputError(f"--scene must be of an object in {mesh.dim} dimensions, as the mesh is, not {scene.dim}")
    none, zero = np.zeros(len(mesh.points), dtype=bool), np.zeros(mesh.points.shape)
    free = Phase("free", 1, none, zero, none, zero)
    mass = mesh.lumped_mass(scene.mass.sum() / scene.mesh.measure().sum())
    everywhere = np.zeros(len(mesh.edges), dtype=int)
    found = {
        material.name: stability.largest_dt(
            replace(scene, mesh=mesh, materials=(material,), edge_material=everywhere, mass=mass, phases=(free,))
        )[0]
        for material in scene.materials
    }
    return {name: dt if isfinite(dt) else None for name, dt in found.items()}


def report_lines(name: str, found: dict) -> list[str]:
    """Return the figures of `inspect` as text."""
    plane = found["dim"] == 2
    low, high = (", ".join(f"{x:.6g}" for x in found["extent"][end]) for end in ("min", "max"))
    ratio, length, meeting = (found[key] for key in ("radius_ratio", "edge_length", "most_edges_at_a_node"))
    parts = "one part" if found["parts"] == 1 else f"{found['parts']} parts that no edge joins"
    said = [
        f"{name}: {found['nodes']} nodes, {found['edges']} edges, {found['elements']} "
        f"{'triangles' if plane else 'tetrahedra'}, {parts}",
        f"  extent             [{low}] to [{high}] m, {found['measure']:.4g} {'m^2' if plane else 'm^3'}",
        f"  edges              {length['min']:.4g} to {length['max']:.4g} m, the shortest between nodes "
        f"{length['shortest'][0]} and {length['shortest'][1]}",
        f"  worst element      {ratio['worst_element']} (nodes {', '.join(map(str, ratio['nodes']))}): radius ratio "
        f"{ratio['min']:.3f}, of all {ratio['mean']:.3f} on average (1: equal sides, 0: flat)",
        f"  edges at a node    {meeting['edges']} at most, at node {meeting['node']} "
        f"(a circuit sums {meeting['allowed']})",
    ]
    for material, dt in (found["stable_dt"] or {}).items():
        said.append(f"  stable dt          {f'{dt:.2g} s' if dt else 'any'} of {material}")
    for board, verdict in found["boards"].items():
        said.append(f"  {board:18} {'fits' if verdict['fits'] else 'does not fit: ' + verdict['too_many']}")
    return said
