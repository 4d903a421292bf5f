"""A whole step in integers: forces add up to 0, order and pauses change no bit, held nodes move as prescribed."""

import numpy as np
from integer_objects import MATERIALS, irregular, pressed, random_image

from golden.datapath.machine import Machine, accumulate
from sim.encode.encode import encode

STATE = "x", "v", "ratio", "force"


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in STATE) and a.faults == b.faults


def test_pulls_are_opposite_integers_on_the_two_ends(rng):
    nodes, edges = 12, 500
    ends, pull = rng.integers(nodes, size=(2, edges)), rng.integers(-(2**30), 2**30, edges)
    forces = accumulate(nodes, ends, pull)
    assert forces.sum() == 0 and forces.any()
    for n in range(nodes):
        assert forces[n] == pull[ends[0] == n].sum() - pull[ends[1] == n].sum()


def test_the_order_of_edges_changes_nothing(rng):
    image = random_image(rng)
    order = rng.permutation(len(image.edges))
    machine = Machine(image)
    machine.step(3)
    for name in ("edges", "edge_material", "length", "ratio"):
        setattr(image, name, getattr(image, name)[order])
    shuffled = Machine(image)
    shuffled.step(3)
    machine.ratio = machine.ratio[order]
    assert same(machine, shuffled)


def test_a_run_in_pieces_is_the_same_run(rng):
    image = random_image(rng)
    whole, pieces = Machine(image), Machine(image)
    whole.step(5)
    pieces.step(2)
    pieces.restart(pieces.v)
    pieces.step(3)
    assert same(whole, pieces)


def test_held_nodes_move_as_prescribed(rng):
    """Their velocity keeps its bits, and their way is its integral: a displacement is rounded once a step."""
    scene = pressed(irregular((3, 3), rng), MATERIALS["rheological"], 60)
    loaded = encode(scene)
    machine, press = Machine(loaded.image), scene.phases[0]
    velocity = loaded.start(press, machine.v)
    machine.restart(velocity)
    machine.step(press.steps)
    held = press.held[loaded.node_order]
    assert np.array_equal(machine.v[held], velocity[held])
    moved = (loaded.positions(machine.x) - loaded.positions(loaded.image.x)) / scene.size
    assert not moved[press.fixed].any()
    way = press.velocity * press.steps * scene.dt / scene.size
    fmt = loaded.image.formats
    rounded = press.steps * (fmt.velocity.lsb * 2.0**-loaded.image.velocity_shift + fmt.position.lsb)
    np.testing.assert_allclose(moved[press.driven], way[press.driven], rtol=0, atol=rounded)
    assert way[press.driven].any()


def test_the_host_can_change_loads_between_steps(rng):
    scene = pressed(irregular((3, 3), rng), MATERIALS["rheological"], 60)
    loaded = encode(scene)
    machine = Machine(loaded.image)
    machine.restart(loaded.start(scene.phases[2], np.zeros_like(machine.v)))
    machine.step()
    assert not machine.force.any() and not machine.v.any()
    free = ~scene.phases[2].held[loaded.node_order]
    loaded.image.load[free, 0] = 1000
    machine.refresh()
    machine.step()
    assert machine.v[free, 0].min() > 0 and not machine.v[~free].any()
