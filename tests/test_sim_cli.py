"""python -m sim: what it writes, what it refuses, and its exit codes."""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scene_text import SCENE, changed, written
from sim_objects import Standin, in_place_of_the_circuit

from golden import model
from golden import scene as scenes
from sim import batch, machines, native, waves
from sim import compare as comparison
from sim.__main__ import main
from sim.compare import power
from sim.folder import MARK
from sim.run import LANES, UPDATES, run

ROOT = Path(__file__).parents[1]
QUICK = changed(SCENE, "duration = 0.01", "duration = 0.002")
HARD = changed(QUICK, "force = [1, 0]", "force = [1e5, 0]")  # saturates


@pytest.fixture
def circuit(monkeypatch):
    stand_in = in_place_of_the_circuit()
    monkeypatch.setattr(machines, "circuit", stand_in)
    monkeypatch.setattr(machines, "check_room", lambda image, parameters: None)
    return stand_in


@pytest.fixture
def scene(tmp_path):
    return str(written(tmp_path, QUICK))


def lines(capsys):
    """What was said on stdout and on stderr."""
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
    expected = {"scene": "block", "backend": backend, "dim": 2, "force_dependent": False, "nodes": 9, "edges": 16,
                "size": 0.2, "steps": 70, "dt": 1e-4, "frames": len(kept.t), "saturations": 0, "faults": {},
                "lanes": None, "updates": None, "cycles": None, "phases": phases,
                "largest_displacement": float(np.linalg.norm(kept.x - kept.x[0], axis=2).max()),
                "final_displacement": float(np.linalg.norm(kept.x[-1] - kept.x[0], axis=1).max())}
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
    assert circuit.asked == [
        (3, 2, out / "waves.vcd"), (LANES, UPDATES, out / "waves.fst"), (LANES, UPDATES, None)]
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


def test_compare(circuit, scene, tmp_path, capsys, monkeypatch):
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


@pytest.mark.parametrize(("command", "file"), [
    (["run", "--backend", "fixed"], "summary.json"), (["compare"], "compare.json"),
])
def test_scripts_get_the_file_itself(command, file, circuit, scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(batch, "cores", lambda: 1)
    assert main([*command, scene, "--json", "--out", str(tmp_path / "out")]) == 0
    assert capsys.readouterr() == ((tmp_path / "out" / file).read_text(), "")


def test_report(circuit, scene, tmp_path, capsys, monkeypatch):
    """The page of runs that are there is that of a comparison, but for how long it took."""
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


def test_what_is_no_run_is_refused_before_anything_is_written(tmp_path, capsys):
    nothing = tmp_path / "nothing"
    refused(["report", str(nothing), "--out", str(tmp_path / "page")],
            f"RUN must be a folder that `python -m sim run` left, not {nothing}: it has no summary.json", capsys)
    assert not (tmp_path / "page").exists()


class OneBit(Standin):
    def step(self, steps: int = 1):
        super().step(steps)
        self.x[0, 0] ^= 1


def test_a_circuit_that_differs_exits_1(circuit, scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(machines, "circuit", in_place_of_the_circuit(OneBit))
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
    assert out == [] and err == [f"internal error: {scene}: the compiled integer model and the NumPy model differ in x "
                                 "after step 20"]
    assert not (tmp_path / "out" / "summary.json").exists()


HELP = "(see python -m sim run --help)"


@pytest.mark.parametrize("arguments, message", [
    ([], "the following arguments are required: COMMAND (see python -m sim --help)"),
    (["walk"], "argument COMMAND: invalid choice: 'walk' (choose from 'run', 'compare', 'figures', 'export', 'report', "
     "'serve', 'bench') (see python -m sim --help)"),
    (["run", "s.toml", "--out", "o"], f"the following arguments are required: --backend {HELP}"),
    (["run", "s.toml", "--backend", "fixed"], f"the following arguments are required: --out {HELP}"),
    (["run", "s.toml", "--backend", "gpu", "--out", "o"], "argument --backend: invalid choice: 'gpu' "
     f"(choose from 'float', 'fixed', 'rtl', 'board') {HELP}"),
    (["run", "s.toml", "--backend", "rtl", "--lanes", "0", "--out", "o"],
     f"argument --lanes: must be a whole number of at least 1, not '0' {HELP}"),
    (["run", "s.toml", "--backend", "rtl", "--lanes", "two", "--out", "o"],
     f"argument --lanes: must be a whole number of at least 1, not 'two' {HELP}"),
    (["run", "s.toml", "--backend", "rtl", "--waves", "png", "--out", "o"],
     f"argument --waves: invalid choice: 'png' (choose from 'vcd', 'fst') {HELP}"),
    (["run", "s.toml", "--backend", "fixed", "--lanes", "2", "--out", "o"],
     "--lanes must go with --backend rtl, not fixed"),
    (["run", "s.toml", "--backend", "float", "--updates", "2", "--out", "o"],
     "--updates must go with --backend rtl, not float"),
    (["run", "s.toml", "--backend", "rtl", "--updates", "3", "--out", "o"],
     "updates must be a whole number from 1 to 2, not 3"),
    (["compare", "s.toml", "--lanes", "9", "--out", "o"], "lanes must be a whole number from 1 to 8, not 9"),
    (["run", "s.toml", "--backend", "float", "--waves", "vcd", "--out", "o"],
     "--waves must go with --backend rtl, not float"),
    (["run", "absent.toml", "--backend", "float", "--out", "o"],
     "absent.toml: the scene must be a readable file: No such file or directory"),
    (["compare"], "the following arguments are required: SCENE (see python -m sim compare --help)"),
    (["report"], "the following arguments are required: RUN (see python -m sim report --help)"),
])
def test_mistakes_in_the_arguments(arguments, message, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    refused(arguments, message, capsys)
    assert not Path("o").exists()


def test_a_mistake_in_a_scene_is_refused_before_anything_runs(scene, tmp_path, capsys):
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(changed(QUICK, "dt = 1e-4", "dt = -1"))
    for arguments in (["run", str(wrong), "--backend", "fixed"], ["compare", scene, str(wrong)]):
        refused([*arguments, "--out", str(tmp_path / "out")], f"{wrong}: dt must be a number above 0, not -1", capsys)
    assert not (tmp_path / "out").exists()


def test_scenes_of_the_same_name_are_refused(scene, tmp_path, capsys):
    refused(["compare", scene, scene, "--out", str(tmp_path / "out")],
            "scenes must have names of their own, not 'block' twice", capsys)


def test_numbers_the_circuit_cannot_hold_name_the_scene(tmp_path, capsys):
    path = written(tmp_path, changed(QUICK, "velocity = [0, -0.5]", "velocity = [0, -1e3]"))
    for arguments in (["run", str(path), "--backend", "fixed"], ["compare", str(path)]):
        refused([*arguments, "--out", str(tmp_path / "out")],
                f"{path}: phases[0].driven must have velocities below 500 m/s, not 1e+03: "
                "the circuit moves a node by less than a quarter of the object's size in a step", capsys)


def test_other_peoples_folders_are_left_alone(scene, tmp_path, capsys):
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    (theirs / "summary.json").write_text("mine")
    run_ = ["run", scene, "--backend", "float", "--out", str(theirs)]
    refused(run_, f"--out must be a new folder or one of earlier results, not {theirs}, which holds other files: "
            "choose another, or add --force to write into it all the same", capsys)
    assert (theirs / "summary.json").read_text() == "mine"
    assert main([*run_, "--force"]) == 0
    assert json.loads((theirs / "summary.json").read_text())["backend"] == "float"


def test_out_must_be_a_folder(scene, tmp_path, capsys):
    refused(["run", scene, "--backend", "float", "--out", scene],
            f"--out must be a folder, not the file {scene}", capsys)
    below = f"{scene}/below"
    refused(["run", scene, "--backend", "float", "--out", below],
            f"--out must be a folder that can be written, not {below}: Not a directory", capsys)


def test_fst_without_its_libraries_is_refused_before_anything_runs(scene, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(waves, "found", lambda header: header == "zlib.h")
    refused(["run", scene, "--backend", "rtl", "--waves", "fst", "--out", str(tmp_path / "out")],
            "waves as fst need a library that is missing: install it (Debian: apt install liblz4-dev), "
            "or take vcd, which needs none", capsys)
    assert not (tmp_path / "out").exists()


def test_an_interrupt_is_quiet(scene, tmp_path, capsys, monkeypatch):
    def interrupted(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(model, "simulate", interrupted)
    assert main(["run", scene, "--backend", "float", "--out", str(tmp_path / "out")]) == 130
    assert lines(capsys) == ([], ["interrupted"])


def test_the_command_itself(scene, tmp_path):
    """Once through the interpreter: exit codes and streams are the shell's."""
    def command(*arguments):
        return subprocess.run([sys.executable, "-m", "sim", *arguments], cwd=ROOT, capture_output=True, text=True)

    done = command("run", scene, "--backend", "float", "--out", str(tmp_path / "out"))
    assert (done.returncode, done.stderr) == (0, "") and done.stdout.startswith("block: 70 steps on float in ")
    done = command("run", scene, "--backend", "gpu", "--out", str(tmp_path / "out"))
    assert (done.returncode, done.stdout) == (2, "") and done.stderr.count("\n") == 1
    done = command("run", "--help")
    assert done.returncode == 0 and "--backend" in done.stdout
