"""A switch of materials between two steps: without a new bitstream and without a jump in force."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from golden.physics import stability
from golden.physics.materials import Material
from golden.physics.switch import switch_material
from golden.support.errors import InputError
from sim.encode.encode import EncodedScene, encode_materials
from sim.encode.units import largest_share, trials_of


def switch(encoded: EncodedScene, machine, materials: tuple[Material, ...]) -> EncodedScene:
    """Give a machine between two steps new materials, one for each that the scene has.

    Parameters
    ----------
    encoded : EncodedScene
        The scene that the machine was loaded with; stays as it is.
    machine : sim.backends.machine.Machine

    Returns
    -------
    EncodedScene
        The scene as the machine has it now: the same object, units and order.

    Raises
    ------
    InputError
        If there are more or fewer materials, one needs a smaller time step, or has forces or coefficients that the
        units of this run can't hold.
    """
    after, fmt = with_materials(encoded, tuple(materials)), encoded.image.formats
    image = replace(
        after.image, x=machine.x, v=machine.v, length=encoded.image.length.copy(), ratio=machine.ratio.copy()
    )
    for number, (old, new) in enumerate(zip(encoded.scene.materials, materials, strict=True)):
        if old == new:
            continue
        edges = image.edge_material == number
        ratio, natural = switch_material(old, new, *_state(encoded, machine, edges))
        length = natural / encoded.units.size
        for words, values, q in ((image.ratio, ratio, fmt.ratio), (image.length, length, fmt.length)):
            try:
                words[edges] = q.quantise(values)
            except ValueError as error:
                raise InputError(f"materials.{new.name} must give edges that the circuit can hold: {error}") from None
    machine.take(image)
    return replace(after, image=image)


def with_materials(encoded: EncodedScene, materials: tuple[Material, ...]) -> EncodedScene:
    """Return the scene with other materials, as it would be at its start. Raises `InputError` as `switch`."""
    scene, fmt = replace(encoded.scene, materials=materials), encoded.image.formats
    if len(materials) != len(encoded.scene.materials):
        raise InputError(
            f"materials must be {len(encoded.scene.materials)}, as many as there were, not {len(materials)}"
        )
    stability.check(scene)
    units = replace(encoded.units, trial=trials_of(scene, materials, encoded.units.velocity))
    for number, m in enumerate(materials):
        if largest_share(m) * units.trial[number] > units.force:
            raise InputError(
                f"materials.{m.name} must have forces below {units.force:.3g} N, the full scale of this "
                f"run, not up to {largest_share(m) * units.trial[number]:.3g} N: begin a run with it"
            )
    fields, damper = encode_materials(materials, units, fmt)
    return replace(encoded, scene=scene, units=units, image=replace(encoded.image, materials=fields, damper=damper))


def _state(encoded: EncodedScene, machine, edges):
    """Return l (m), dl/dt (m/s), a and L (m) of some edges, in the circuit's order."""
    fmt, units, ends = encoded.image.formats, encoded.units, encoded.image.edges[edges].T
    d, w = (
        q.to_float(raw[ends[1]] - raw[ends[0]]) * unit
        for raw, q, unit in ((machine.x, fmt.position, units.size), (machine.v, fmt.velocity, units.velocity))
    )
    length = np.linalg.norm(d, axis=1)
    rate = (d * w).sum(axis=1) / length
    ratio = fmt.ratio.to_float(machine.ratio[edges])
    natural = fmt.length.to_float(encoded.image.length[edges]) * units.size
    return length, rate, ratio, natural
