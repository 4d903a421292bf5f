"""Every shipped scene on the simulated circuit: the same bits for any number of lanes and any order of edges."""

from pathlib import Path

import numpy as np
import pytest

from golden.scene import load as scene
from sim.run import run

SCENES = sorted((Path(__file__).resolve().parent.parent / "scenes").glob("*.toml"))
pytestmark = pytest.mark.campaign


@pytest.fixture(scope="module")
def fixed():
    """Return the integer model's run of a scene, computed once."""
    results = {}

    def of(path):
        if path not in results:
            results[path] = run(scene.load(path), "fixed")
        return results[path]

    return of


def test_there_are_scenes():
    assert len(SCENES) >= 13


@pytest.mark.parametrize("lanes", [1, 2, 4])
@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_any_number_of_lanes_gives_the_same_bits(path, lanes, fixed):
    circuit = run(scene.load(path), "rtl", lanes=lanes)
    assert circuit.raw.same(fixed(path).raw)
    assert circuit.faults == fixed(path).faults == {}


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_shuffled_edges_give_the_same_bits(path, fixed, rng):
    loaded = scene.load(path)
    shuffled = rng.permutation(len(loaded.mesh.edges))
    circuit = run(loaded, "rtl", lanes=2, edge_order=shuffled)
    assert np.array_equal(circuit.trajectory.edges, fixed(path).trajectory.edges)
    assert circuit.raw.same(fixed(path).raw)
