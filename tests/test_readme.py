"""The README is short, its scene does what it says, and its table has every scene that ships."""

import documents

from environment import ROOT
from golden.physics import model
from golden.scene import load as scene

README = (ROOT / "README.md").read_text()


def test_it_is_short():
    assert len(README.splitlines()) <= 220


def test_the_scene_runs(tmp_path):
    (block,) = (block for block in documents.blocks(README) if block.language == "toml")
    file = tmp_path / block.name
    file.write_text(block.text)
    example = scene.load(file)
    assert len(example.frames) >= 60
    run = model.simulate(example)
    height = run.x[:, :, 1].max(axis=1)
    assert height.min() < 0.076 < 0.08 < height[-1] < 0.097  # pressed, and back part of the way


def test_the_table_of_make_has_every_scene_that_ships():
    (block,) = (block for block in documents.blocks(README) if block.language == "text")
    rows = [line.split() for line in block.text.splitlines() if line.endswith("passes")]
    paths = {row[0]: ROOT / "scenes" / f"{row[0]}.toml" for row in rows}
    assert set(paths.values()) == set((ROOT / "scenes").glob("*.toml"))
    for name, dimension, nodes, edges, steps, *_ in rows:
        one = scene.load(paths[name])
        assert (int(dimension), int(nodes), int(edges)) == (one.mesh.dim, len(one.mesh.points), len(one.mesh.edges))
        assert int(steps) == sum(phase.steps for phase in one.phases)
