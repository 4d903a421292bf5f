"""The project's own file, pyproject.toml."""

import tomllib

from golden.support.paths import ROOT


def project() -> dict:
    """The table ``project``: name, version, dependencies ..."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def version() -> str:
    return project()["version"]
