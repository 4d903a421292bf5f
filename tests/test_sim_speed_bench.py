"""python -m sim bench: its files and tables, its refusals, and the source of the circuit's cycles."""

import json
import sys

import pytest

from golden.support.errors import InputError
from sim.__main__ import main
from sim.results import cycles
from sim.results import step_time as steptime
from sim.speed import bench, meshes, table, timing

KEYS = [
    "mesh",
    "lanes",
    "updates",
    "nodes",
    "edges",
    "clock_mhz",
    "cycles_per_step",
    "occupancy",
    "step_us",
    "edge_evals_per_s",
    "software",
]


def software(scene, steps, progress):
    """Stand in for `sim.speed.timing.software`."""
    times = {
        "threads": 2,
        "steps": steps,
        "step_us": 20.0,
        "p999_us": 30.0,
        "max_us": 4000.0,
        "clock_us": 0.02,
        "running": 0.99,
    }
    for name in timing.SOFTWARE:
        progress(name)
    return dict.fromkeys(timing.SOFTWARE, times)


@pytest.fixture
def quick(monkeypatch):
    """Replace the timing of software."""
    monkeypatch.setattr(timing, "software", software)
    monkeypatch.setattr(
        cycles, "cycles_per_step", lambda scene, lanes, updates: 4 * len(scene.mesh.edges) // lanes + 250
    )


def test_an_entry_follows_from_cycles_and_clock():
    scene = meshes.scene("9x9")
    entry = bench.entry(scene, 4, 1, 500, 100.0, software(scene, 10, print))
    assert list(entry) == KEYS
    assert entry["step_us"] == 5.0 and entry["occupancy"] == 4 * 208 / (4 * 500)
    assert entry["edge_evals_per_s"] == pytest.approx(4 * 208 / 5e-6)
    assert {name: program["ratio"] for name, program in entry["software"].items()} == dict.fromkeys(timing.SOFTWARE, 4)


def test_the_command_writes_entries_and_shows_two_tables(quick, tmp_path, capsys):
    out = tmp_path / "a" / "bench.json"
    assert main(["bench", "--meshes", "9x9", "5x5x5", "--steps", "7", "--clock", "100", "--out", str(out)]) == 0
    entries = json.loads(out.read_text())
    assert [(e["mesh"], e["lanes"], e["updates"]) for e in entries] == [
        (mesh, *circuit) for mesh in ("9x9", "5x5x5") for circuit in bench.CIRCUITS
    ]
    assert all(list(e) == KEYS for e in entries)
    assert [p.name for p in out.parent.iterdir()] == ["bench.json"]
    said, err = capsys.readouterr()
    assert err == ""
    lines = said.splitlines()
    assert max(map(len, lines)) <= 120
    assert lines[5].split() == ["9x9", "81", "208", "1", "1", "1082", "0.769", "10.82", "76.9", *["20.0", "1.85"] * 3]
    assert ["5x5x5", *["20.0", "30.0", "4000.0"] * 3] in [line.split() for line in lines]
    assert "steps: 7," in said and "warning" not in said


def test_all_meshes_fit_on_a_screen_with_the_clock_of_a_timed_board(quick, tmp_path, capsys):
    assert main(["bench", "--out", str(tmp_path / "bench.json")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert f"at {steptime.clock('ulx3s-85f'):g} MHz." in lines[1]
    assert len(lines) < 50 and max(map(len, lines)) <= 120
    assert list(dict.fromkeys(line.split()[0] for line in lines[5:35])) == list(meshes.MESHES)


def test_a_machine_that_others_use_is_noticed(quick, tmp_path, capsys, monkeypatch):
    def busy(*arguments):
        figures = software(*arguments)
        figures["numba_all_threads"] = {**figures["numba_all_threads"], "running": 0.6}
        return figures

    monkeypatch.setattr(timing, "software", busy)
    assert main(["bench", "--meshes", "9x9", "--out", str(tmp_path / "bench.json")]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == (
        "warning: other programs used the machine, the software's times are too long: Numba-all had 60% of its cores"
    )


def test_progress_is_shown_on_a_terminal(quick, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert main(["bench", "--meshes", "3x3", "--out", str(tmp_path / "bench.json")]) == 0
    lines = capsys.readouterr().err.split("\r\x1b[K")
    assert lines == ["", *(f"3x3: {name} ..." for name in timing.SOFTWARE.values()), ""]


@pytest.mark.parametrize(
    "arguments, message",
    [
        (
            ["--steps", "0"],
            "argument --steps: must be a whole number of at least 1, not '0' (see python -m sim bench --help)",
        ),
        (
            ["--clock", "0"],
            "argument --clock: must be a finite number above 0, not '0' (see python -m sim bench --help)",
        ),
        (
            ["--clock", "fast"],
            "argument --clock: must be a finite number above 0, not 'fast' (see python -m sim bench --help)",
        ),
        (["--meshes", "9"], "meshes must be numbers of nodes like 9x9 or 5x5x5, not '9'"),
        (["--meshes", "1x9"], "nodes must be 2 whole numbers of at least 2, not [1, 9]"),
    ],
)
def test_mistakes_in_the_arguments_are_one_line(quick, arguments, message, tmp_path, capsys):
    assert main(["bench", *arguments, "--out", str(tmp_path / "bench.json")]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err == f"error: {message}\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("out, reason", [("folder", "Is a directory"), ("file/bench.json", "Not a directory")])
def test_out_is_refused_before_anything_is_timed(quick, out, reason, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(cycles, "cycles_per_step", lambda *circuit: pytest.fail("nothing may be run"))
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    assert main(["bench", "--out", str(tmp_path / out)]) == 2
    reasons = reason, "File exists"
    assert capsys.readouterr().err in [
        f"error: --out must be a file that can be written, not {tmp_path / out}: {reason}\n" for reason in reasons
    ]


@pytest.mark.parametrize(
    "lanes, updates, message",
    [
        (1, 3, "updates must be 1 or 2, not 3"),
        (9, 1, "lanes must be a whole number from 1 to 8, not 9"),
    ],
)
def test_circuits_that_do_not_exist_are_refused(lanes, updates, message):
    with pytest.raises(InputError, match=f"^{message}$"):
        cycles.cycles_per_step(meshes.scene("9x9"), lanes, updates)


def test_processor_has_a_name():
    assert table.processor()
