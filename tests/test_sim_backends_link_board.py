"""The driver against the whole simulated circuit on a socket: the same bits as without a link, or one line of error."""

import re
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import scene_text
from integer_objects import random_image
from served import SMALL, Service, serial_circuit, served

from hw.link.description import key
from hw.link.registers import LINK, Link
from hw.map.control import Control
from hw.map.memory_map import Map, Region, join
from hw.parameters import Parameters
from sim.__main__ import main
from sim.backends.circuit import CircuitMachine
from sim.backends.link import board as driver
from sim.backends.link.board import Board
from sim.backends.link.errors import CommandRefused, LineBroken, LinkError, OtherCircuit
from sim.backends.native import NativeMachine

RHEOLOGICAL = Path(__file__).parents[1] / "scenes" / "rheological.toml"


@pytest.fixture
def service():
    with served() as it:
        yield it


def control(register):
    return Map(SMALL).address(Region.CONTROL, 0, register)


def runs(scene, service, folder) -> tuple:
    """Return the results that ``run`` writes for a scene on the board and on the simulated circuit."""
    out = [folder / name for name in ("board", "rtl")]
    assert main(["run", str(scene), "--backend", "board", "--port", service.url, "--out", str(out[0])]) == 0
    assert main(["run", str(scene), "--backend", "rtl", "--out", str(out[1])]) == 0
    return tuple(dict(np.load(path / "trajectory.npz")) for path in out)


def test_a_scene_on_a_board_has_the_bits_of_the_simulated_circuit(service, tmp_path, capsys):
    board, rtl = runs(scene_text.written(tmp_path), service, tmp_path)
    assert all(np.array_equal(board[name], rtl[name], equal_nan=True) for name in rtl) and len(board["x"]) > 3
    assert "block: 150 steps on board" in capsys.readouterr().out


@pytest.mark.campaign
def test_the_whole_rheological_scene_has_the_bits_of_the_simulated_circuit(tmp_path, figure):
    with served(Parameters(lanes=1, nodes=128, edges=256, materials=2, tables=1)) as service:
        board, rtl = runs(RHEOLOGICAL, service, tmp_path)
    assert set(board) == set(rtl) and len(board["x"]) > 30 and np.ptp(board["a"]) > 0.1
    differ = [name for name in rtl if not np.array_equal(board[name], rtl[name], equal_nan=True)]
    figure(f"arrays of {RHEOLOGICAL.name}, run on the served top level, that are not equal to rtl", 0, len(differ))
    assert not differ


def test_a_board_keeps_its_state_between_sessions(service, rng):
    for _ in range(3):
        image = random_image(rng, nodes=20, edges=40, materials=2, tables=1)
        model, board = NativeMachine(image), Board.at(service.url)
        machine = CircuitMachine(image, board, verify=board.verify)
        for steps in (1, 20):
            model.step(steps)
            machine.step(steps)
            for name in ("x", "v", "ratio", "force"):
                assert np.array_equal(getattr(machine, name), getattr(model, name)), name
        assert board.counters()["crc_errors"] == 0 < board.counters()["good_frames"]
        machine.close()


def test_memories_that_differ_are_noticed(service, rng):
    image, board = random_image(rng, nodes=20, edges=40, materials=2, tables=1), Board.at(service.url)
    writes = []

    def verify(pairs):
        writes.extend(pairs)
        board.verify(pairs)

    CircuitMachine(image, board, verify=verify)
    address, word = next((a, w) for a, w in writes if Region(a >> 24) == Region.EDGE)
    board.write([(address, word ^ 1)])
    with pytest.raises(LinkError, match="the circuit's memories must hold what was written, but their CRC differs"):
        board.verify(writes)
    board.close()


def test_a_refused_write_is_an_error(service):
    board = Board.at(service.url)
    with pytest.raises(
        CommandRefused, match="the circuit must accept each command, but answered REFUSED: at least one word was"
    ):
        board.write([(control(Control.MAGIC), 1)])
    board.close()


def test_a_run_that_an_earlier_host_began_is_ended(service, rng):
    image, first = random_image(rng, nodes=20, edges=40, materials=2, tables=1), Board.at(service.url)
    CircuitMachine(image, first)
    first.write([(control(Control.RUN), 1 << 31)])
    assert first.run()
    first.close()
    second = Board.at(service.url)
    assert not second.run()
    second.close()


def test_a_reset_in_between_is_noticed(rng):
    circuit = serial_circuit()
    service = Service(circuit)
    board = Board.at(service.url, timeout=1)
    circuit.reset()
    with pytest.raises(LinkError, match="the circuit must not be reset while it is used, but it was: start again"):
        board.read([control(Control.MAGIC)])
    board.close()
    service.stop()
    circuit.close()


def test_a_watchdog_is_set_in_seconds(service):
    board = Board.at(service.url)
    board.watch(0.5)
    assert int(board.read([join(LINK, 0, Link.WATCHDOG, 0)])[0]) == 12_000_000
    board.close()


def test_a_port_that_is_not_there_is_named(tmp_path, capsys):
    scene, out = str(scene_text.written(tmp_path)), tmp_path / "out"
    assert main(["run", scene, "--backend", "board", "--port", "/dev/nowhere", "--out", str(out)]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: --port must be a port that can be opened, not /dev/nowhere: ") and "doctor" in error
    assert error.count("\n") == 1 and not (out / "trajectory.npz").exists()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--backend", "board"], "--port must say where the board is (make doctor lists the ports of this machine)"),
        (["--backend", "rtl", "--port", "x"], "--port must go with --backend board, not rtl"),
        (["--backend", "fixed", "--baud", "9600"], "--baud must go with --backend board, not fixed"),
    ],
)
def test_options_that_do_not_go_together(arguments, message, tmp_path, capsys):
    scene = str(scene_text.written(tmp_path))
    assert main(["run", scene, *arguments, "--out", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err == f"error: {message}\n"


def test_a_cable_that_is_unplugged_leaves_nothing_half_written(tmp_path, capsys):
    circuit = serial_circuit()
    service = Service(circuit)
    text = scene_text.changed(scene_text.SCENE, "duration = 0.01\n", "duration = 2.0\n")
    scene, out = str(scene_text.written(tmp_path, text)), tmp_path / "out"
    unplugged = threading.Timer(4.0, service.stop)
    unplugged.start()
    began = time.monotonic()
    assert main(["run", scene, "--backend", "board", "--port", service.url, "--out", str(out)]) == 2
    assert time.monotonic() - began < 30
    unplugged.join()
    circuit.close()
    error = capsys.readouterr().err
    assert re.fullmatch(rf"error: .*--port must stay connected, but {service.url} is gone: .*\n", error), error
    assert not (out / "trajectory.npz").exists() and not (out / "summary.json").exists()


def test_an_object_that_is_too_large_is_refused(service, tmp_path, capsys):
    text = scene_text.changed(scene_text.SCENE, "nodes = [3, 3]", "nodes = [9, 9]")
    text = scene_text.changed(text, "nodes = [4]", "nodes = [40]")
    scene = str(scene_text.written(tmp_path, text))
    assert main(["run", scene, "--backend", "board", "--port", service.url, "--out", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err == (
        f"error: {scene}: nodes of the object must be at most 32 for this circuit, not 81: choose a smaller object, or "
        "build a circuit that holds it\n"
    )


def test_a_circuit_with_another_map_is_refused(service, monkeypatch):
    other = key(Parameters())
    monkeypatch.setattr(driver, "key", lambda parameters: other)
    message = (
        f"--port must lead to a circuit with memory map {other.hex()}, as in this version, but the one at "
        f"{service.url} has {key(SMALL).hex()}: build and load the circuit again (make bitstream, make flash), or use "
        "the version that it was built with"
    )
    with pytest.raises(OtherCircuit, match=re.escape(message)):
        Board.at(service.url)


def test_a_device_that_is_not_a_circuit_is_refused(service, monkeypatch):
    monkeypatch.setattr(driver, "MAGIC", 5)
    message = "--port must lead to a circuit of this version, not the one at .*: magic must be 0x5, not 0x5248454f"
    with pytest.raises(OtherCircuit, match=message):
        Board.at(service.url)


def test_a_line_that_is_gone_is_one_error(service):
    board = Board.at(service.url)
    service.stop()
    with pytest.raises(LineBroken, match=f"--port must stay connected, but {service.url} is gone: "):
        for _ in range(100):
            board.read([control(Control.MAGIC)])
    board.close()


@pytest.mark.parametrize(
    ("port", "message"),
    [
        ("70000", "argument --port: must be a whole number from 0 to 65535, not '70000'"),
        ("x", "argument --port: must be a whole number from 0 to 65535, not 'x'"),
    ],
)
def test_a_port_to_serve_on_is_a_number(port, message, capsys):
    assert main(["serve", "--port", port]) == 2
    assert capsys.readouterr().err == f"error: {message} (see python -m sim serve --help)\n"


def test_a_port_that_is_taken_is_not_served_on(service, capsys):
    taken = service.url.rpartition(":")[2]
    assert main(["serve", "--port", taken]) == 2
    assert capsys.readouterr().err.startswith(f"error: --port must be a free port of this machine, not {taken}: ")
