"""Set up the checkout's virtual environment: report missing system packages, then install requirements.lock once.

    python3 environment.py           check and install; the Makefile's targets begin with it
    python3 environment.py --lock    resolve the pins of pyproject.toml again and write requirements.lock

It uses the standard library only, and no syntax newer than Python 3.6: an old ``python3`` must reach the line that
refuses it.
"""

import ctypes
import ctypes.util
import fcntl
import hashlib
import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys
import sysconfig
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent
OLDEST = (3, 11)
VERSION = "{}.{}".format(*sys.version_info)
# program -> (description, Debian package)
PROGRAMS = {"c++": ("a C++ compiler (c++)", "g++"), "make": ("make", "make"), "perl": ("perl", "perl")}
# only for tests of the report's page, which are skipped without it
BROWSER = {"chromium": ("a browser (chromium)", "chromium")}


def libpython():
    """Return whether this Python's shared library can be loaded; cocotb embeds the interpreter in the simulator."""
    name = sysconfig.get_config_var("INSTSONAME") or ""
    architecture = sysconfig.get_config_var("MULTIARCH") or ""
    folders = [pathlib.Path(sysconfig.get_config_var("LIBDIR") or "/"), pathlib.Path(sys.base_prefix, "lib")]
    candidates = [str(folder / part / name) for folder in folders for part in ("", architecture)]
    for candidate in [*candidates, ctypes.util.find_library("python" + VERSION)]:
        try:
            if candidate:
                ctypes.CDLL(candidate)
                return True
        except OSError:
            continue
    return False


def checked():
    """Return (description, Debian package, whether it is there) of each requirement that pip can't install."""
    programs = [(what, package, bool(shutil.which(program))) for program, (what, package) in PROGRAMS.items()]
    venv = bool(importlib.util.find_spec("venv") and importlib.util.find_spec("ensurepip"))
    return programs + [
        ("Python's venv module", f"python{VERSION}-venv", venv),
        (f"the shared library of Python {VERSION}", f"libpython{VERSION}", libpython()),
    ]


def browser():
    """Return the same as `checked` for what only some tests need."""
    return [(what, package, bool(shutil.which(program))) for program, (what, package) in BROWSER.items()]


def missing():
    """Return a line for each missing requirement that pip can't install, with the package to install."""
    if sys.version_info < OLDEST:
        return [
            f"python3 must be Python {OLDEST[0]}.{OLDEST[1]} or newer, not {VERSION}: install one, "
            "or name the one to use: make PYTHON=python3.12"
        ]
    return [f"{what} is missing: {install_it(package)}" for what, package, there in checked() if not there]


def install_it(package):
    return f"install it (Debian: apt install {package})"


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def pip(python):
    return python, "-m", "pip", "install", "-qq", "--disable-pip-version-check", "--no-input"


def install(root=ROOT):
    """Make root/.venv agree with root/requirements.lock and this Python; do nothing when it already does.

    The stamp is written last, so an interrupted installation starts again from scratch.
    """
    lock, venv = root / "requirements.lock", root / ".venv"
    stamp, python = venv / "installed", venv / "bin" / "python"
    with lock.open("rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)  # of two makes at once the second waits and finds everything installed
        wanted = f"{hashlib.sha256(file.read()).hexdigest()} {sys.base_prefix} {sys.version}\n"
        if python.exists() and stamp.exists() and stamp.read_text() == wanted:
            return
        print("setting up .venv from requirements.lock ...", flush=True)
        run(sys.executable, "-m", "venv", "--clear", venv)
        run(*pip(python), "--no-deps", "--no-compile", "-r", lock)
        stamp.write_text(wanted)


def resolve(root=ROOT):
    """Write root/requirements.lock: the pins of root/pyproject.toml and all their dependencies."""
    import tomllib

    direct = tomllib.loads((root / "pyproject.toml").read_text())["project"]["dependencies"]
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder, "report.json")
        run(*pip(sys.executable), "--dry-run", "--ignore-installed", "--report", report, *direct)
        found = [item["metadata"] for item in json.loads(report.read_text())["install"]]
    pins = sorted(f"{item['name'].lower().replace('_', '-')}=={item['version']}\n" for item in found)
    head = "# Everything that is installed, exactly: written by `make lock` from the pins of pyproject.toml\n"
    (root / "requirements.lock").write_text(head + "".join(pins))


def main(arguments):
    """Return the exit code: 0, 2 if something is missing or the installation fails, 130 if it is interrupted."""
    lines = missing()
    for line in lines:
        print("error: " + line, file=sys.stderr)
    if lines:
        return 2
    try:
        resolve() if "--lock" in arguments else install()
    except subprocess.CalledProcessError:
        print("error: the installation failed, the lines above say why", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
