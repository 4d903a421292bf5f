"""python -m sim: the files that it writes, its messages and its exit codes."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scene_text import SCENE, changed, written
from sim_objects import Standin, in_place_of_the_circuit

from golden.physics import model
from golden.scene import load as scenes
from sim.__main__ import main
from sim.backends import native, waves
from sim.backends.registry import BACKENDS
from sim.backends.rtl import RtlBackend
from sim.results import comparison
from sim.results.comparison import power
from sim.run import LANES, UPDATES, run
from sim.support import batch
from sim.support.folder import MARK

ROOT = Path(__file__).parents[1]
QUICK = changed(SCENE, "duration = 0.01", "duration = 0.002")
HARD = changed(QUICK, "force = [1, 0]", "force = [1e5, 0]")  # saturates


@pytest.fixture
def circuit(monkeypatch):
    stand_in = in_place_of_the_circuit()
    monkeypatch.setitem(BACKENDS, RtlBackend.name, stand_in)
    return stand_in


@pytest.fixture
def scene(tmp_path):
    return str(written(tmp_path, QUICK))


def lines(capsys):
    """Return the lines on stdout and on stderr."""
    said = capsys.readouterr()
    return said.out.splitlines(), said.err.splitlines()


def refused(arguments, message, capsys):
    assert main(arguments) == 2
    out, err = lines(capsys)
    assert out == [] and err == [f"error: {message}"]


@pytest.mark.parametrize("backend", ["float", "fixed"])
def test_run_writes_the_trajectory_and_a_summary(backend, scene, tmp_path, capsys):
    out = tmp_path / "a" / "b"
    assert main(["run", scene, "--backend", backend, "--out", str(out)]) == 0
    assert {path.name for path in out.iterdir()} == {MARK, "scene.npz", "trajectory.npz", "summary.json"}
    loaded = scenes.load(scene)
    kept = run(loaded, backend).trajectory
    with np.load(out / "trajectory.npz") as archive:
        assert set(archive) == {"t", "x", "v", "a", "reaction", "edges"}
        for name in archive:
            np.testing.assert_array_equal(archive[name], getattr(kept, name))
    summary = json.loads((out / "summary.json").read_text())
    phases = [{"name": "press", "steps": 20}, {"name": "phase 2", "steps": 50}]
    expected = {
        "scene": "block",
        "backend": backend,
        "dim": 2,
        "force_dependent": False,
        "nodes": 9,
        "edges": 16,
        "size": 0.2,
        "steps": 70,
        "dt": 1e-4,
        "frames": len(kept.t),
        "saturations": 0,
        "faults": {},
        "lanes": None,
        "updates": None,
        "cycles": None,
        "phases": phases,
        "largest_displacement": float(np.linalg.norm(kept.x - kept.x[0], axis=2).max()),
        "final_displacement": float(np.linalg.norm(kept.x[-1] - kept.x[0], axis=1).max()),
    }
    assert {key: summary[key] for key in expected} == expected
    assert (summary["units"] is None) == (backend == "float")
    out, err = lines(capsys)
    assert err == [] and len(out) == 1 and out[0].startswith(f"block: 70 steps on {backend} in ")


def test_run_on_the_circuit(circuit, scene, tmp_path, monkeypatch):
    monkeypatch.setattr(waves, "found", lambda header: True)
    out = tmp_path / "out"
    assert main(["run", scene, "--backend", "rtl", "--lanes", "3", "--updates", "2", "--waves", "--out", str(out)]) == 0
    assert main(["run", scene, "--backend", "rtl", "--waves", "fst", "--out", str(out)]) == 0
    assert main(["run", scene, "--backend", "rtl", "--out", str(out)]) == 0
    assert circuit.asked == [(3, 2, out / "waves.vcd"), (LANES, UPDATES, out / "waves.fst"), (LANES, UPDATES, None)]
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["lanes"], summary["updates"], summary["cycles"]) == (LANES, UPDATES, 7000)


def test_a_later_run_replaces_the_earlier_ones_files(scene, tmp_path):
    out = tmp_path / "out"
    assert main(["run", scene, "--backend", "fixed", "--out", str(out)]) == 0
    (out / "waves.vcd").write_text("of an earlier run")
    (out / "notes.txt").write_text("the user's")
    assert main(["run", scene, "--backend", "float", "--out", str(out)]) == 0
    assert json.loads((out / "summary.json").read_text())["backend"] == "float"
    assert {path.name for path in out.iterdir()} == {MARK, "scene.npz", "trajectory.npz", "summary.json", "notes.txt"}


def test_saturation_in_a_run_exits_1(tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["run", str(written(tmp_path, HARD)), "--backend", "fixed", "--out", str(out)]) == 1
    _, err = lines(capsys)
    faults = json.loads((out / "summary.json").read_text())["faults"]
    assert faults and err == [f"error: saturated: {', '.join(sorted(faults))}"]


def test_compare_writes_a_page_and_prints_a_table(circuit, scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(batch, "cores", lambda: 1)  # the stand-in for the circuit is not in other processes
    second = tmp_path / "second.toml"
    second.write_text(changed(QUICK, '"block"', '"other"'))
    out = tmp_path / "report"
    assert main(["compare", scene, str(second), "--lanes", "3", "--updates", "2", "--out", str(out)]) == 0
    entries = json.loads((out / "compare.json").read_text())
    assert [(e["scene"], e["lanes"], e["updates"]) for e in entries] == [("block", 3, 2), ("other", 3, 2)]
    assert {path.name for path in out.iterdir()} == {MARK, "compare.json", "index.html"}
    said, err = lines(capsys)
    assert err == [] and "circuit with 3 lanes" in said[0]
    rows = [line.split() for line in said if line.startswith(("block", "other"))]
    for entry, row in zip(entries, rows, strict=True):
        assert row[:6] == [entry["scene"], "2", "9", "16", "70", "yes"] and row[-1] == "passes"
        assert row[6:10] == [power(entry["max_dx_rel"]), "1e-5", power(entry["max_da"]), "0"]
    assert max(map(len, said)) <= 105 and len(said) <= 12


@pytest.mark.parametrize(
    ("command", "file"),
    [
        (["run", "--backend", "fixed"], "summary.json"),
        (["compare"], "compare.json"),
    ],
)
def test_json_prints_the_file_itself(command, file, circuit, scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(batch, "cores", lambda: 1)
    assert main([*command, scene, "--json", "--out", str(tmp_path / "out")]) == 0
    assert capsys.readouterr() == ((tmp_path / "out" / file).read_text(), "")


def test_report_writes_the_page_of_existing_runs(circuit, scene, tmp_path, capsys, monkeypatch):
    """The page of existing runs is that of a comparison, except for the time it took."""
    monkeypatch.setattr(batch, "cores", lambda: 1)
    runs, pages = [], {}
    for backend in ("fixed", "rtl"):
        runs.append(str(tmp_path / backend))
        assert main(["run", scene, "--backend", backend, "--out", runs[-1]]) == 0
    for command in (["report", *runs], ["compare", scene]):
        out = tmp_path / command[0]
        capsys.readouterr()
        assert main([*command, "--out", str(out)]) == 0
        said, err = lines(capsys)
        assert err == [] and said[4].split()[:6] == ["block", "2", "9", "16", "70", "yes"]
        assert {path.name for path in out.iterdir()} == {MARK, "compare.json", "index.html"}
        (entry,) = json.loads((out / "compare.json").read_text())
        entry.pop("seconds")
        pages[command[0]] = entry | {"backends": sorted(entry["backends"])}
    assert pages["report"] == pages["compare"]


def test_a_report_of_integers_alone(scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(batch, "cores", lambda: 1)
    assert main(["run", scene, "--backend", "fixed", "--out", str(tmp_path / "run")]) == 0
    assert main(["report", str(tmp_path / "run"), "--out", str(tmp_path / "page")]) == 0
    said, err = lines(capsys)
    assert err == [] and said[1].startswith("circuit against integer model")
    assert said[-1].split()[5] == "-" and said[-1].split()[-1] == "passes"


def test_a_run_that_saturated_fails_in_the_report_too(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(batch, "cores", lambda: 1)
    main(["run", str(written(tmp_path, HARD)), "--backend", "fixed", "--out", str(tmp_path / "run")])
    capsys.readouterr()
    assert main(["report", str(tmp_path / "run"), "--out", str(tmp_path / "page")]) == 1
    _, err = lines(capsys)
    assert any(line.startswith("error: block: saturated: ") for line in err)


def test_a_folder_without_a_run_is_refused_before_anything_is_written(tmp_path, capsys):
    nothing = tmp_path / "nothing"
    refused(
        ["report", str(nothing), "--out", str(tmp_path / "page")],
        f"RUN must be a folder that `python -m sim run` left, not {nothing}: it has no summary.json",
        capsys,
    )
    assert not (tmp_path / "page").exists()


class OneBit(Standin):
    def step(self, steps: int = 1):
        super().step(steps)
        self.x[0, 0] ^= 1


def test_a_circuit_that_differs_exits_1(circuit, scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setitem(BACKENDS, RtlBackend.name, in_place_of_the_circuit(OneBit))
    assert main(["compare", scene, "--out", str(tmp_path / "out")]) == 1
    said, err = lines(capsys)
    assert err == ["error: block: the circuit's frames differ from the integer model's"]
    assert any(line.startswith("block") and "NO" in line and line.rstrip().endswith("FAILS") for line in said)


def test_a_missed_figure_exits_1(circuit, scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(comparison, "BOUND", {False: 1e-12, True: 1e-12})
    assert main(["compare", scene, "--out", str(tmp_path / "out")]) == 1
    _, err = lines(capsys)
    assert len(err) == 1 and err[0].startswith("error: block: max_dx_rel must be at most 1e-12, not ")


def test_a_saturation_exits_1(circuit, tmp_path, capsys):
    assert main(["compare", str(written(tmp_path, HARD)), "--out", str(tmp_path / "out")]) == 1
    _, err = lines(capsys)
    assert any(line.startswith("error: block: saturated: ") for line in err)


def test_two_models_that_disagree_are_an_internal_error(scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(native, "NativeMachine", OneBit)
    assert main(["run", scene, "--backend", "fixed", "--out", str(tmp_path / "out")]) == 1
    out, err = lines(capsys)
    assert out == [] and err == [
        f"internal error: {scene}: the compiled integer model and the NumPy model differ in x after step 20"
    ]
    assert not (tmp_path / "out" / "summary.json").exists()


def test_an_interrupt_is_quiet(scene, tmp_path, capsys, monkeypatch):
    def interrupted(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(model, "simulate", interrupted)
    assert main(["run", scene, "--backend", "float", "--out", str(tmp_path / "out")]) == 130
    assert lines(capsys) == ([], ["interrupted"])


def test_the_command_itself_runs(scene, tmp_path):
    """Once through the interpreter, with real exit codes and streams."""

    def command(*arguments):
        return subprocess.run([sys.executable, "-m", "sim", *arguments], cwd=ROOT, capture_output=True, text=True)

    done = command("run", scene, "--backend", "float", "--out", str(tmp_path / "out"))
    assert (done.returncode, done.stderr) == (0, "") and done.stdout.startswith("block: 70 steps on float in ")
    done = command("run", scene, "--backend", "gpu", "--out", str(tmp_path / "out"))
    assert (done.returncode, done.stdout) == (2, "") and done.stderr.count("\n") == 1
    done = command("run", "--help")
    assert done.returncode == 0 and "--backend" in done.stdout
