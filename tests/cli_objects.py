"""The command line of hw, with a stand-in for the emitter."""

from hw_objects import core_to_ask

from hw.__main__ import main
from hw.emit import build

SMALL = ["--lanes", "2", "--nodes", "16", "--edges", "20", "--materials", "3", "--tables", "1"]
TEXT = "module rheogate(clk);\nendmodule\n"


def record_circuits(monkeypatch):
    """Replace the emitter. Return the list to which it appends the parameters of each circuit it is asked for."""
    asked = []

    def emit(parameters):
        asked.append(parameters)
        return TEXT, core_to_ask(parameters)

    monkeypatch.setattr(build, "emit", emit)
    return asked


def output(capsys):
    """Return the lines of standard output and of standard error."""
    captured = capsys.readouterr()
    return captured.out.splitlines(), captured.err.splitlines()


def refused(arguments, message, capsys):
    """Hold that a command ends with exit code 2 and this message alone."""
    capsys.readouterr()
    assert main(arguments) == 2
    assert output(capsys) == ([], [f"error: {message}"])


def write_verilog(out, *options):
    """Return the exit code of the command that writes a small circuit."""
    return main(["verilog", *SMALL, "--out", str(out), *options])
