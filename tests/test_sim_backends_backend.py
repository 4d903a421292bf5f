"""sim.backends: a backend is one object, and every machine has the same interface."""

import ast
import inspect
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from scene_text import SCENE, changed, written
from sim_objects import block

from golden.datapath.machine import Machine as NumpyMachine
from golden.support.errors import InputError
from hw.parameters import Parameters
from sim.__main__ import main, parser
from sim.backends.backend import Backend, IntegerBackend, Option
from sim.backends.circuit import Circuit, CircuitMachine
from sim.backends.fixed import FixedBackend
from sim.backends.float64 import Float64Machine, FloatBackend
from sim.backends.link.board import Board
from sim.backends.machine import ClockedMachine, FloatMachine, Machine
from sim.backends.native import NativeMachine
from sim.backends.registry import BACKENDS
from sim.backends.rtl import RtlBackend
from sim.backends.simulated_circuit import SimulatedCircuit
from sim.compare import compare
from sim.encode.encode import encode
from sim.run import run
from sim.support.arguments import whole

SIM = Path(__file__).parents[1] / "sim"


@dataclass(frozen=True)
class Mirrored(FloatBackend):
    """The float model, with positions mirrored along an axis that is its own option."""

    axis: int = 1

    name = "mirrored"
    words = "float64 in a mirror"
    summary = "float64, seen in a mirror"
    compared = False
    options = (Option("axis", "the axis that is mirrored (1)", {"type": whole, "metavar": "AXIS"}),)

    @classmethod
    def from_options(cls, args, out):
        return cls(args.axis or 1)

    def check(self):
        if self.axis > 2:
            raise InputError(f"--axis must be 1 or 2, not {self.axis}")

    @contextmanager
    def open(self, scene):
        yield Mirror(scene, self.axis)


@dataclass(frozen=True)
class Mirror:
    scene: object
    axis: int

    def simulate(self, progress=None):
        trajectory = Float64Machine(self.scene).simulate(progress)
        trajectory.x[:, :, self.axis - 1] *= -1
        return trajectory


@dataclass(frozen=True)
class Numpy(IntegerBackend):
    """The NumPy model under a name of its own."""

    name = "numpy"
    words = "NumPy"
    summary = "the integer model in NumPy"

    @contextmanager
    def open(self, encoded):
        yield NumpyMachine(encoded.image)


@pytest.fixture
def registered(monkeypatch):
    for backend in (Mirrored, Numpy):
        monkeypatch.setitem(BACKENDS, backend.name, backend)


def test_a_backend_made_here_is_run_by_name(registered):
    scene = block(steps=(10, 5, 5))
    exact = run(scene, "float").trajectory.x
    mirrored = run(scene, "mirrored")
    assert mirrored.backend == "mirrored" and mirrored.raw is None
    np.testing.assert_array_equal(mirrored.trajectory.x * [-1, 1], exact)
    np.testing.assert_array_equal(run(scene, Mirrored(axis=2)).trajectory.x * [1, -1], exact)
    assert run(scene, "numpy").raw.same(run(scene, "fixed").raw)


def test_a_backend_made_here_is_run_by_the_command_line(registered, tmp_path, capsys):
    path = str(written(tmp_path, changed(SCENE, "duration = 0.01", "duration = 0.002")))
    out = str(tmp_path / "out")
    arguments = ["run", path, "--backend", "mirrored", "--out", out]
    assert main([*arguments, "--axis", "2"]) == 0
    assert capsys.readouterr().out.startswith("block: 70 steps on mirrored in ")
    assert main([*arguments, "--axis", "3"]) == 2
    assert capsys.readouterr().err == "error: --axis must be 1 or 2, not 3\n"
    assert main(["run", path, "--backend", "float", "--axis", "1", "--out", out]) == 2
    assert capsys.readouterr().err == "error: --axis must go with --backend mirrored, not float\n"
    with pytest.raises(SystemExit):
        parser().parse_args(["run", "--help"])
    words = " ".join(capsys.readouterr().out.split())
    assert "mirrored: float64, seen in a mirror" in words and "mirrored: the axis that is mirrored (1)" in words
    # its runs are taken up again like any other's
    assert main(["run", path, "--backend", "numpy", "--out", str(tmp_path / "numpy")]) == 0
    assert main(["report", str(tmp_path / "numpy"), "--out", str(tmp_path / "page")]) == 0
    assert "NumPy" in (tmp_path / "page" / "index.html").read_text()


def test_a_backend_that_is_not_registered_is_unknown():
    with pytest.raises(InputError, match=r"^backend must be one of float, fixed, rtl, board, not 'mirrored'$"):
        run(block(), "mirrored")


def test_a_backend_that_is_compared_takes_part_in_a_comparison(monkeypatch):
    class Compared(Numpy):
        compared = True

    class Fixed(FixedBackend):
        compared = False

    class Rtl(RtlBackend):
        compared = False

    for backend in (Compared, Fixed, Rtl):
        monkeypatch.setitem(BACKENDS, backend.name, backend)
    entry = compare(block(steps=(10, 5, 5))).entry()
    assert entry["backends"] == ["float", "numpy"] and entry["saturations"] == 0


@pytest.mark.parametrize("backend", BACKENDS.values(), ids=BACKENDS)
def test_a_backend_says_what_it_is(backend):
    assert issubclass(backend, Backend) and backend.integers == issubclass(backend, IntegerBackend)
    assert backend.name and backend.words and backend.summary
    assert len({option.name for option in backend.options}) == len(backend.options)


def test_machines_have_one_interface():
    """The board's machine is a `CircuitMachine` too; here registers stand in for the circuit."""
    image, parameters = encode(block(steps=(5, 5, 5))).image, Parameters(lanes=2)
    circuit = CircuitMachine(image, Registers(parameters))
    for machine in (NumpyMachine(image), NativeMachine(image), circuit):
        assert isinstance(machine, Machine), type(machine)
        assert machine.x.shape == machine.v.shape == machine.force.shape == image.x.shape
        assert machine.ratio.shape == image.ratio.shape and not machine.faults
        assert isinstance(machine, ClockedMachine) == (machine is circuit)
    circuit.step(3)
    assert circuit.cycles == 0 and circuit.parameters is parameters
    assert not isinstance(object(), Machine)
    assert isinstance(Float64Machine(block()), FloatMachine) and not isinstance(object(), FloatMachine)


def parameters_of(kind, method) -> list[str]:
    return list(inspect.signature(getattr(kind, method)).parameters)


@pytest.mark.parametrize(
    ("protocol", "kinds", "methods"),
    [
        (Machine, (NumpyMachine, NativeMachine, CircuitMachine), {"step", "restart", "take"}),
        (FloatMachine, (Float64Machine,), {"simulate"}),
    ],
)
def test_methods_take_the_arguments_of_their_protocol(protocol, kinds, methods):
    assert methods == {name for name, member in vars(protocol).items() if callable(member) and name[0] != "_"}
    for kind in kinds:
        for method in methods:
            assert parameters_of(kind, method) == parameters_of(protocol, method), kind


@pytest.mark.parametrize("kind", [SimulatedCircuit, Board])
def test_the_methods_of_a_circuit_take_the_arguments_of_its_protocol(kind):
    for method in ("write", "read", "run", "wait", "close"):
        assert parameters_of(kind, method) == parameters_of(Circuit, method), method


class Registers:
    """A circuit that holds what is written and computes nothing."""

    def __init__(self, parameters):
        self.parameters, self.faults, self.words = parameters, ["position"], {}

    def write(self, writes):
        self.words.update(writes)

    def read(self, addresses):
        return np.array([0 for _ in addresses], np.uint64)

    def run(self, cycles=0):
        return False

    def wait(self):
        pass

    def close(self):
        pass


NOT_BACKENDS = {
    ("report/pack.py", "fixed"): "nodes that are held",
    ("results/step_time.py", "board"): "a key of compare.json",
}


def test_only_its_own_module_names_a_backend_by_a_string():
    homes = {FloatBackend: "float64.py", FixedBackend: "fixed.py"}
    found = set()
    for path in SIM.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Constant) and node.value in BACKENDS:
                found.add((path.relative_to(SIM).as_posix(), node.value))
    own = {(f"backends/{homes.get(backend, f'{name}.py')}", name) for name, backend in BACKENDS.items()}
    assert found == own | set(NOT_BACKENDS)
