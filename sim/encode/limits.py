"""The limits of the circuit's numbers: a scene beyond them is refused, by name, before anything runs."""

from __future__ import annotations

import numpy as np

from golden.datapath import records
from golden.datapath.formats import Formats
from golden.physics.scene import Scene
from golden.support.errors import InputError
from sim.encode.encode import EncodedScene, encode
from sim.encode.switch import with_materials


def encode_checked(scene: Scene, edge_order: np.ndarray | None = None) -> EncodedScene:
    """Return the scene of `sim.encode.encode.encode` once the numbers of every phase have been tried.

    Raises `InputError` that names what doesn't fit.
    """
    _check_speed(scene)
    try:
        encoded = encode(scene, edge_order=edge_order)
        for phase in scene.phases[::-1]:  # the first one last: it stays
            encoded.start(phase, encoded.image.v)
            _check_masses(encoded)
    except InputError:
        raise
    except (ValueError, OverflowError) as error:
        raise InputError(f"the scene must have numbers that the circuit can hold: {error}") from None
    for variant in (encoded, *later_materials(encoded)):
        record = records.material(variant.image.formats, len(variant.image.damper["rho_value"]))
        for material, fields in zip(variant.scene.materials, variant.image.materials, strict=True):
            _check(record, fields, f"materials.{material.name} must have coefficients")
    return encoded


def later_materials(encoded: EncodedScene) -> list[EncodedScene]:
    """Return the scene with the materials that each later phase brings, as it would be at its own start."""
    return [with_materials(encoded, materials) for materials in encoded.scene.material_sets[1:]]


def _check_speed(scene: Scene) -> None:
    """Raise `InputError` where a node would move further in a step than the displacement format reaches."""
    limit = 2.0 ** (Formats().displacement.int_bits - 1) * scene.size / scene.dt
    for n, phase in enumerate(scene.phases):
        fastest = np.abs(phase.velocity[phase.driven]).max(initial=0)
        if fastest >= limit:
            raise InputError(
                f"phases[{n}].driven must have velocities below {limit:.3g} m/s, not {fastest:.3g}: "
                "the circuit moves a node by less than a quarter of the object's size in a step"
            )


def _check_masses(encoded: EncodedScene) -> None:
    record = records.inverse_mass(encoded.image.formats)
    for n, node in enumerate(encoded.node_order):
        fields = {name: values[n] for name, values in encoded.image.inverse_mass.items()}
        _check(record, fields, f"mass must give node {node} a factor")


def _check(record, fields, what: str) -> None:
    try:
        record.pack(fields)
    except ValueError as error:
        raise InputError(f"{what} that the circuit can hold, beside the scene's other forces: {error}") from None
