"""A switch of materials in a run of the simulated circuit: the same bits as an integer model that begins there, no jump
in force, and the new material's behaviour from there on."""

import dataclasses

import numpy as np
import pytest
from rtl_objects import circuit, rtl_machine
from sim_objects import MATERIALS, block

from golden.datapath.machine import Machine
from golden.physics.materials import rheological, viscoelastic
from golden.support.errors import InputError
from sim.backends.native import NativeMachine
from sim.encode.encode import encode
from sim.encode.switch import switch


def pressed(name, steps=60):
    """Return the encoded scene and the circuit, in which a block is being held."""
    loaded = encode(block(name, steps=(40, 40, 40)))
    machine = rtl_machine(loaded.image, parameters=circuit(2))
    machine.step(40)
    machine.restart(loaded.start(loaded.scene.phases[1], machine.v))
    machine.step(steps)
    return loaded, machine


@pytest.mark.parametrize(
    "names",
    [("viscoelastic", "rheological"), ("rheological", "viscoelastic"), ("rheological", "rheological-force")],
    ids="-".join,
)
def test_a_switch_keeps_the_force_and_goes_on_as_the_model_does(names):
    loaded, machine = pressed(names[0])
    unswitched = NativeMachine(dataclasses.replace(loaded.image, x=machine.x, v=machine.v, ratio=machine.ratio))
    unswitched.step(1)
    after = switch(loaded, machine, (MATERIALS[names[1]],))
    model = NativeMachine(dataclasses.replace(after.image))
    model.force = machine.force.copy()
    for steps in (1, 30):
        machine.step(steps)
        model.step(steps)
        for name in ("x", "v", "ratio", "force"):
            assert np.array_equal(getattr(machine, name), getattr(model, name)), name
        if steps == 1:  # the last of a step's forces: the materials differ in what they do within the step
            largest = np.abs(unswitched.force).max()
            assert np.abs(machine.force - unswitched.force).max() < 0.05 * largest and largest > 1 << 20
    machine.close()


def test_a_switch_must_bring_as_many_materials_as_the_scene_has():
    loaded = encode(block("rheological"))
    with pytest.raises(InputError, match="materials must be 1, as many as there were, not 2"):
        switch(loaded, None, (MATERIALS["rheological"],) * 2)


def test_a_material_that_needs_a_smaller_time_step_is_refused():
    loaded = encode(block("rheological"))
    with pytest.raises(InputError, match="dt must be at most"):
        switch(loaded, None, (viscoelastic("steel", 1e6, 1.0),))


def test_a_material_beyond_the_units_of_the_run_is_refused():
    loaded = encode(block(rheological("down", 0.5, 0.001, 5.0)))
    with pytest.raises(
        InputError,
        match=r"materials.dough must have forces below .* N, the full scale of this run, "
        r"not up to .* N: begin a run with it",
    ):
        switch(loaded, None, (rheological("dough", 200.0, 0.5, 20.0),))


def test_natural_lengths_beyond_their_format_are_refused():
    """A weak spring would carry the force of a strong one only with a natural length of many sizes."""
    encoded = encode(block("rheological"))
    machine = Machine(encoded.image)
    machine.x = machine.x * 2
    with pytest.raises(InputError, match=r"materials\.weak must give edges that the circuit can hold: length must be "):
        switch(encoded, machine, (rheological("weak", 0.1, 0.5, 20.0),))
