"""The frames of the shipped scenes keep their bits: whoever changes the arithmetic changes ``frames.json``
knowingly."""

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

from environment import ROOT
from golden.scene import load as scene
from sim.run import run

KEPT = json.loads(Path(__file__).with_name("frames.json").read_text())
"""SHA-256 of each scene's positions, velocities and ratios at all frames, as little-endian 64-bit integers."""


def digest(raw) -> str:
    parts = (np.ascontiguousarray(part, dtype="<i8").tobytes() for part in (raw.x, raw.v, raw.ratio))
    return hashlib.sha256(b"".join(parts)).hexdigest()


def test_every_shipped_scene_is_kept():
    assert sorted(KEPT) == sorted(path.stem for path in (ROOT / "scenes").glob("*.toml"))


@pytest.mark.parametrize("name", sorted(KEPT))
def test_the_integer_model_keeps_every_bit(name):
    assert digest(run(scene.load(ROOT / "scenes" / f"{name}.toml"), "fixed").raw) == KEPT[name]


def test_one_bit_changes_the_digest():
    raw = run(scene.load(ROOT / "scenes" / "plastic.toml"), "fixed").raw
    raw.ratio[-1, -1] ^= 1
    assert digest(raw) != KEPT["plastic"]


@pytest.mark.campaign
@pytest.mark.parametrize("name", sorted(KEPT))
def test_the_circuit_keeps_every_bit(name):
    assert digest(run(scene.load(ROOT / "scenes" / f"{name}.toml"), "rtl").raw) == KEPT[name]
