"""environment.py: missing packages are named, nothing is installed twice, an interrupted installation starts again."""

import re
import shutil
import subprocess
import sys
import tomllib
import warnings
from importlib.metadata import distribution

import pytest

import environment
from environment import ROOT, VERSION


@pytest.fixture
def lacking(monkeypatch):
    """Give a function that takes programs and modules away from the machine."""

    def lack(*names):
        which, find = environment.shutil.which, environment.importlib.util.find_spec
        monkeypatch.setattr(environment.shutil, "which", lambda name: None if name in names else which(name))
        monkeypatch.setattr(environment.importlib.util, "find_spec", lambda name: None if name in names else find(name))
        if "libpython" in names:
            monkeypatch.setattr(environment, "libpython", lambda: False)

    return lack


@pytest.mark.parametrize(
    "name, message",
    [
        ("c++", "error: a C++ compiler (c++) is missing: install it (Debian: apt install g++)"),
        ("make", "error: make is missing: install it (Debian: apt install make)"),
        ("perl", "error: perl is missing: install it (Debian: apt install perl)"),
        ("ensurepip", f"error: Python's venv module is missing: install it (Debian: apt install python{VERSION}-venv)"),
        (
            "libpython",
            f"error: the shared library of Python {VERSION} is missing: "
            f"install it (Debian: apt install libpython{VERSION})",
        ),
    ],
)
def test_a_missing_package_is_named(lacking, monkeypatch, capsys, name, message):
    monkeypatch.setattr(environment, "install", lambda: pytest.fail("nothing may be installed"))
    lacking(name)
    assert environment.main([]) == 2
    assert capsys.readouterr().err == message + "\n"


def test_all_missing_packages_are_named(lacking):
    lacking("c++", "perl")
    assert len(environment.missing()) == 2


def test_a_missing_browser_is_reported_but_not_required(lacking):
    lacking("chromium")
    assert environment.browser() == [("a browser (chromium)", "chromium", False)]
    assert environment.missing() == []


def test_an_old_python_is_refused(monkeypatch):
    monkeypatch.setattr(environment, "OLDEST", (3, 99))
    assert environment.missing() == [
        f"python3 must be Python 3.99 or newer, not {VERSION}: install one, "
        "or name the one to use: make PYTHON=python3.12"
    ]


def test_a_missing_shared_library_is_noticed(monkeypatch):
    assert environment.libpython()
    monkeypatch.setattr(environment.sysconfig, "get_config_var", lambda name: None)
    monkeypatch.setattr(environment.ctypes.util, "find_library", lambda name: None)
    assert not environment.libpython()


@pytest.fixture
def checkout(tmp_path, monkeypatch):
    """Give (a checkout with an empty lock, the commands run in it); no command really runs."""
    ran = []

    def run(*command):
        ran.append(command[2])
        if command[2] == "venv":
            shutil.rmtree(tmp_path / ".venv", ignore_errors=True)  # --clear
            (tmp_path / ".venv" / "bin").mkdir(parents=True)
            (tmp_path / ".venv" / "bin" / "python").touch()

    (tmp_path / "requirements.lock").touch()
    monkeypatch.setattr(environment, "run", run)
    return tmp_path, ran


def test_the_second_time_nothing_is_installed(checkout):
    root, ran = checkout
    for _ in range(2):
        environment.install(root)
        assert ran == ["venv", "pip"]


@pytest.mark.parametrize(
    "change",
    [
        lambda root: (root / ".venv" / "installed").unlink(),  # as an interruption leaves it
        lambda root: (root / ".venv" / "bin" / "python").unlink(),  # the Python that made it was removed
        lambda root: (root / "requirements.lock").write_text("numpy==2.4.6\n"),
    ],
)
def test_a_changed_checkout_is_installed_again(checkout, change):
    root, ran = checkout
    environment.install(root)
    change(root)
    environment.install(root)
    assert ran == ["venv", "pip"] * 2


def test_a_failed_installation_is_one_error(checkout, monkeypatch, capfd):
    root, _ = checkout

    def fail(*command):
        raise subprocess.CalledProcessError(1, command)

    monkeypatch.setattr(environment, "run", fail)
    monkeypatch.setattr(environment.install, "__defaults__", (root,))
    assert environment.main([]) == 2
    assert capfd.readouterr().err == "error: the installation failed, the lines above say why\n"
    assert not (root / ".venv" / "installed").exists()


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
    done = subprocess.run(
        ["make", "--no-print-directory", "help", f"PYTHON={sys.executable}"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    phony = re.search(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text(), re.M)[1].split()
    assert {line.split()[1] for line in done.stdout.splitlines()} == set(phony) - {"environment"}


def test_warnings_fail_the_tests():
    with pytest.raises(UserWarning, match="as an error"):
        warnings.warn("as an error", stacklevel=1)
