"""hw.emit.lint: Verilator's own failures are no warnings."""

import pytest

from hw.emit import lint
from hw.emit.build import VERILOG


def test_a_failure_of_verilator_is_passed_on(tmp_path, monkeypatch):
    class Done:
        returncode, stderr = 127, "no such library\n"

    monkeypatch.setattr(lint.subprocess, "run", lambda *args, **kwargs: Done)
    with pytest.raises(RuntimeError, match="verilator failed: no such library"):
        lint.lint(tmp_path / VERILOG, top="rheogate")
