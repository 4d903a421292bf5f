"""The simulated circuit against the compiled integer model: every bit, for any number of lanes and any order."""

import dataclasses

import numpy as np
import pytest
from integer_objects import random_image
from rtl_objects import STATE, assert_same, circuit, renumbered, rtl_machine, run, scene

from golden.datapath.formats import Formats
from golden.support.errors import InputError
from hw.machine.host_port import LATENCY
from hw.map.control import MAGIC, Control
from hw.map.memory_map import Map, Region
from hw.parameters import Parameters
from sim.backends.native import NativeMachine
from sim.backends.rtl import BUILD
from sim.encode.encode import encode
from sim.encode.order import ranks
from sim.encode.program import Program
from sim.results.cycles import Wavefront

LANES = 2, *(pytest.param(lanes, marks=pytest.mark.campaign) for lanes in (1, 4))


@pytest.fixture
def simulated():
    """Return a function that makes machines in the simulated circuit; they are closed in the end."""
    machines = []

    def make(image, parameters, **kwargs):
        machines.append(rtl_machine(image, parameters=parameters, folder=BUILD, **kwargs))
        return machines[-1]

    yield make
    for machine in machines:
        machine.close()


@pytest.mark.parametrize("lanes", LANES)
@pytest.mark.parametrize("name", ["2-D", "3-D", "fan"])
def test_an_object_of_all_materials_has_the_models_bits(name, lanes, rng, simulated):
    loaded = encode(scene(name, rng, 300))
    expected = list(run(loaded, NativeMachine(loaded.image)))
    machine = simulated(loaded.image, circuit(lanes))
    assert_same(run(loaded, machine), expected)
    assert not machine.faults and (expected[0]["x"] != expected[-1]["x"]).any()
    assert (expected[0]["ratio"] != expected[-1]["ratio"]).any()


@pytest.mark.parametrize("lanes", LANES)
def test_no_order_of_edges_or_nodes_changes_a_bit(lanes, rng, simulated):
    """Edges in reverse, random and by their first ends; nodes numbered at random and in reverse."""
    for name in ("2-D", "3-D", "fan"):
        one = scene(name, rng, 30)
        mesh, edges = one.mesh, len(one.mesh.edges)
        quick = encode(one)
        expected = list(run(quick, NativeMachine(quick.image)))
        by_node = np.lexsort(ranks(quick.node_order)[mesh.edges].T[::-1])
        orders = quick.edge_order[::-1], rng.permutation(edges), by_node
        objects = [encode(one, edge_order=order) for order in orders]
        nodes = len(mesh.points)
        objects += [renumbered(encode(one), order) for order in (rng.permutation(nodes), np.arange(nodes)[::-1])]
        cycles = set()
        for loaded in objects:
            machine = simulated(loaded.image, circuit(lanes))
            assert_same(run(loaded, machine), expected)
            cycles.add(machine.cycles)
        assert len(cycles) > 1  # the order does reach the circuit


@pytest.mark.parametrize("lanes", LANES)
def test_saturating_images_have_the_models_bits_and_faults(lanes, seed, simulated):
    faults = set()
    for number in range(8):
        image = random_image(np.random.default_rng([seed, number]))
        model, machine = NativeMachine(image), simulated(image, circuit(lanes))
        for steps in (1, 1, 5):
            model.step(steps)
            machine.step(steps)
            for name in STATE:
                assert np.array_equal(getattr(machine, name), getattr(model, name)), name
            assert set(machine.faults) == set(model.faults)
        faults |= set(machine.faults)
    assert len(faults) >= 10


def test_a_run_in_pieces_is_the_same_run_and_its_cycles_add_up(rng, simulated):
    loaded = encode(scene("2-D", rng, 30))
    model, pieces = NativeMachine(loaded.image), simulated(loaded.image, circuit(2))
    assert pieces.cycles == 0 and not pieces.force.any()
    for steps in (1, 3, 6):
        before, clock = pieces.cycles, pieces.circuit.clock
        pieces.step(steps)
        model.step(steps)
        assert all(np.array_equal(getattr(pieces, name), getattr(model, name)) for name in STATE)
        counted = pieces.cycles - before
        assert len(loaded.image.edges) / 2 * 4 * steps < counted < pieces.circuit.clock - clock


def test_after_a_reset_at_any_cycle_the_machine_says_so_and_is_loaded_again(rng, simulated):
    """500 resets in the middle of a run and around its beginning; an object loaded afterwards runs as ever."""
    loaded = encode(scene("2-D", rng, 30))
    expected = NativeMachine(loaded.image)
    expected.step(1)
    machine, map_ = simulated(loaded.image, circuit(2)), Map(circuit(2))
    circuit_, program = machine.circuit, Program(loaded.image, circuit(2))
    kept = [(address, data) for address, data in program.load() if address < map_.address(Region.MATERIAL)]
    kept += program.start(loaded.image.v, loaded.image.x)  # a reset leaves materials and tables, which no run changes
    registers = {r: map_.address(Region.CONTROL, 0, r) for r in Control}
    for cycles in rng.integers(0, 2000, 500):
        circuit_.write([(registers[Control.RUN], 1000)])
        circuit_.run(int(cycles))
        assert cycles < 3 or circuit_.read([registers[Control.BUSY]])[0] == 1
        circuit_.reset()
        asked = [Control.MAGIC, Control.BUSY, Control.ROW_COUNT, Control.NODE_COUNT, Control.STEPS_DONE, Control.FAULTS]
        assert circuit_.read([registers[r] for r in asked]).tolist() == [MAGIC, 0, 0, 0, 0, 0]
        circuit_.write(kept)
        machine.step(1)
        assert all(np.array_equal(getattr(machine, name), getattr(expected, name)) for name in STATE)


def test_a_run_that_is_stopped_ends_with_a_step_and_goes_on_with_the_same_bits(rng, simulated):
    """Resets at any cycle of a run, with one object: no state is written back between the runs."""
    loaded = encode(scene("2-D", rng, 30))
    model, machine, map_ = NativeMachine(loaded.image), simulated(loaded.image, circuit(2)), Map(circuit(2))
    ends, circuit_ = Wavefront(loaded.image, circuit(2)).run(20), machine.circuit
    run, stop, done, cycles = (
        map_.address(Region.CONTROL, 0, getattr(Control, name)) for name in ("RUN", "STOP", "STEPS_DONE", "CYCLES")
    )
    seen = set()
    for under_way in [0, 1, 2, 3, *rng.integers(0, ends[4], 200).tolist()]:
        circuit_.write([(run, 1000)])
        circuit_.run(under_way)
        circuit_.write([(stop, 1)])
        circuit_.wait()
        steps, took = circuit_.read([done, cycles]).tolist()
        assert took == ends[steps - 1]
        assert took >= under_way and (steps < 3 or ends[steps - 3] <= under_way + LATENCY)
        model.step(steps)
        machine.fetch()
        assert all(np.array_equal(getattr(machine, name), getattr(model, name)) for name in STATE)
        seen.add(steps)
    assert len(seen) >= 4
    circuit_.write([(stop, 1)])  # nothing to stop: the next run is a whole one
    machine.step(3)
    assert circuit_.read([done]).tolist() == [3]


def test_a_refused_request_raises(rng, simulated):
    machine = simulated(random_image(rng), circuit(1))
    read_only = Map(circuit(1)).address(Region.CONTROL, 0, Control.STEPS_DONE)
    with pytest.raises(RuntimeError, match=rf"^the circuit refused a write to {read_only:#x}$"):
        machine.circuit.write([(read_only, 5)])
    with pytest.raises(RuntimeError, match=r"^the circuit refused to read 0xffff$"):
        machine.circuit.read([0xFFFF])


@pytest.mark.parametrize(
    ("smaller", "message"),
    [
        (dict(nodes=11), "nodes of the object must be at most 11 for this circuit, not 12"),
        (dict(edges=59), "edges of the object must be at most 59 for this circuit, not 60"),
        (dict(lanes=4, edges=55), "edges of the object must be at most 56 for this circuit, not 60"),
        (dict(materials=7), "materials of the object must be at most 7 for this circuit, not 8"),
        (dict(tables=2), "tables of the object must be at most 2 for this circuit, not 3"),
        (
            dict(formats=Formats(16, 34)),
            r"formats of the object must be the circuit's Formats\(operand=16, state=34\), "
            r"not Formats\(operand=18, state=36\)",
        ),
    ],
)
def test_an_object_that_is_too_large_is_refused_by_name(smaller, message, rng):
    room = dict(lanes=1, nodes=12, edges=60, materials=8, tables=3)
    Program(random_image(rng), Parameters(**room))
    with pytest.raises(InputError, match=f"^{message}$"):
        Program(random_image(rng), Parameters(**room | smaller))


def test_a_node_with_too_many_edges_is_refused(rng):
    image = random_image(rng, nodes=40, edges=32)
    image.edges = np.stack([np.zeros(32, int), np.arange(1, 33)], 1)
    Program(dataclasses.replace(image, edges=image.edges[:31], edge_material=image.edge_material[:31]), circuit(1))
    with pytest.raises(InputError, match=r"^edges at one node must be at most 31, so that no sum overflows, not 32$"):
        Program(image, circuit(1))
