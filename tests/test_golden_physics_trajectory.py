"""Trajectory files: saved and loaded, atomic, reproducible."""

import numpy as np
import pytest

from golden.physics.trajectory import Trajectory, load

RUN = Trajectory(
    t=np.array([0.0, 0.1]),
    x=np.arange(8.0).reshape(2, 2, 2),
    v=-np.arange(8.0).reshape(2, 2, 2),
    a=np.array([[0.5], [np.nextafter(0.5, 1)]]),
    reaction=np.ones((2, 2, 2)),
    edges=np.array([[0, 1]]),
)
ARRAYS = ("t", "x", "v", "a", "reaction", "edges")


def test_a_saved_trajectory_is_loaded_bit_for_bit(tmp_path):
    RUN.save(tmp_path / "run.npz")
    read = load(tmp_path / "run.npz")
    for name in ARRAYS:
        assert np.array_equal(getattr(read, name), getattr(RUN, name)), name
        assert getattr(read, name).dtype == getattr(RUN, name).dtype


def test_meta_is_saved_with_the_arrays(tmp_path):
    RUN.save(tmp_path / "run.npz", backend="float", lanes=4)
    with np.load(tmp_path / "run.npz") as archive:
        assert set(archive) == {*ARRAYS, "backend", "lanes"}
        assert (str(archive["backend"]), int(archive["lanes"])) == ("float", 4)
    assert load(tmp_path / "run.npz").t.tolist() == [0.0, 0.1]


def test_meta_cannot_replace_an_array(tmp_path):
    with pytest.raises(ValueError, match=r"^meta must have names of its own, not a, x$"):
        RUN.save(tmp_path / "run.npz", x=1, a=2, lanes=4)
    assert not list(tmp_path.iterdir())


def test_a_file_is_written_whole_or_not_at_all(tmp_path):
    RUN.save(tmp_path / "run.npz")
    before = (tmp_path / "run.npz").read_bytes()
    with pytest.raises(ValueError, match="Object arrays cannot be saved"):
        RUN.save(tmp_path / "run.npz", meta={"not": "an array"})
    assert [path.name for path in tmp_path.iterdir()] == ["run.npz"]
    assert (tmp_path / "run.npz").read_bytes() == before


def test_the_same_run_gives_the_same_bytes(tmp_path):
    for name in ("one.npz", "two.npz"):
        RUN.save(tmp_path / name, backend="float")
    assert (tmp_path / "one.npz").read_bytes() == (tmp_path / "two.npz").read_bytes()
