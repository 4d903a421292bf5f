"""environment.py: what is missing is named, nothing is installed twice, an interruption is made good."""
import re
import subprocess
import sys
import tomllib
from importlib.metadata import distribution

import pytest

import environment
from environment import ROOT, VERSION


@pytest.fixture
def lacking(monkeypatch):
    """A machine without the programs and modules named."""

    def lack(*names):
        which, find = environment.shutil.which, environment.importlib.util.find_spec
        monkeypatch.setattr(environment.shutil, "which", lambda name: None if name in names else which(name))
        monkeypatch.setattr(environment.importlib.util, "find_spec",
                            lambda name: None if name in names else find(name))
        if "libpython" in names:
            monkeypatch.setattr(environment, "libpython", lambda: False)

    return lack


@pytest.mark.parametrize("name, message", [
    ("c++", "error: a C++ compiler (c++) is missing: install it (Debian: apt install g++)"),
    ("make", "error: make is missing: install it (Debian: apt install make)"),
    ("perl", "error: perl is missing: install it (Debian: apt install perl)"),
    ("ensurepip", "error: Python's venv module is missing: "
                  f"install it (Debian: apt install python{VERSION}-venv)"),
    ("libpython", f"error: the shared library of Python {VERSION} is missing: "
                  f"install it (Debian: apt install libpython{VERSION})"),
])
def test_names_what_is_missing(lacking, monkeypatch, capsys, name, message):
    monkeypatch.setattr(environment, "install", lambda: pytest.fail("nothing may be installed"))
    lacking(name)
    assert environment.main([]) == 2
    assert capsys.readouterr().err == message + "\n"


def test_names_all_that_is_missing(lacking):
    lacking("c++", "perl")
    assert len(environment.missing()) == 2


def test_old_python(monkeypatch):
    monkeypatch.setattr(environment, "OLDEST", (3, 99))
    assert environment.missing() == [f"python3 must be Python 3.99 or newer, not {VERSION}: install one, "
                                     "or name the one to use: make PYTHON=python3.12"]


def test_shared_library_is_looked_for(monkeypatch):
    assert environment.libpython()
    monkeypatch.setattr(environment.sysconfig, "get_config_var", lambda name: None)
    monkeypatch.setattr(environment.ctypes.util, "find_library", lambda name: None)
    assert not environment.libpython()


def test_installs_once(tmp_path, capfd):
    lock, stamp = tmp_path / "requirements.lock", tmp_path / ".venv" / "installed"
    witness = tmp_path / ".venv" / "witness"

    def installs():
        environment.install(tmp_path)
        return bool(capfd.readouterr().out)

    lock.write_text("")
    assert installs() and not installs()
    witness.touch()
    stamp.unlink()  # what an interruption leaves behind
    assert installs() and not witness.exists()
    lock.write_text("# changed\n")
    assert installs() and not installs()


def test_failed_installation(tmp_path, monkeypatch, capfd):
    (tmp_path / "requirements.lock").write_text("not a pin\n")
    monkeypatch.setattr(environment.install, "__defaults__", (tmp_path,))
    assert environment.main([]) == 2
    assert capfd.readouterr().err.splitlines()[-1] == \
        "error: the installation failed, the lines above say why"
    assert not (tmp_path / ".venv" / "installed").exists()


def pins(lines):
    return dict(re.fullmatch(r"([a-z0-9-]+)==(\S+)", line).groups() for line in lines)


def locked():
    lines = (ROOT / "requirements.lock").read_text().splitlines()
    return pins(line for line in lines if not line.startswith("#"))


def test_lock_holds_the_direct_pins():
    direct = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    assert pins(direct).items() <= locked().items()


def test_lock_is_closed_and_installed():
    for name, version in locked().items():
        found = distribution(name)
        assert found.version == version
        for requirement in found.requires or []:
            if ";" not in requirement:  # an extra, or for another Python or system
                needed = re.match(r"[\w.-]+", requirement)[0].lower().replace("_", "-")
                assert needed in locked(), f"{name} needs {needed}"


def test_every_dependency_has_a_reason():
    text = (ROOT / "pyproject.toml").read_text()
    listed = re.search(r"^dependencies = \[\n(.*?)^\]", text, re.S | re.M)[1].splitlines()
    lines = [line for line in listed if not line.lstrip().startswith("#")]
    assert len(lines) > 10
    for line in lines:
        assert re.search(r'",\s+# .{10,}', line), line


def test_make_help_lists_every_target():
    done = subprocess.run(["make", "--no-print-directory", "help", f"PYTHON={sys.executable}"], cwd=ROOT,
                          capture_output=True, text=True, check=True)
    phony = re.search(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text(), re.M)[1].split()
    assert {line.split()[1] for line in done.stdout.splitlines()} == set(phony) - {"environment"}
