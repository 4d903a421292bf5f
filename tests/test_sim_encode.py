"""sim.encode.units, sim.encode.encode and sim.encode.limits: SI numbers survive being encoded and decoded."""

from dataclasses import replace

import golden_objects as objects
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sim_objects import DT, MATERIALS, MESHES, block

from golden.datapath.formats import Formats
from golden.datapath.machine import Machine
from golden.mesh import mesh
from golden.physics import materials
from golden.support.errors import InputError
from sim.encode import limits
from sim.encode.coefficients import coefficient, coefficients
from sim.encode.encode import encode
from sim.encode.order import order, ranks
from sim.encode.units import HEADROOM, choose, expected_speed
from sim.run import run

FMT = Formats()
MANTISSA = 2.0**-FMT.mantissa.frac_bits  # relative, of a coefficient in [1/2, 1)


def mixed(**kwargs):
    """Two materials, gravity and a load on every node, so that no two numbers of the image are alike."""
    m = MESHES[2]
    push = 0.01 * np.arange(24).reshape(12, 2)
    phases = [
        objects.phase(m, 20, objects.bottom(m), (objects.top(m), (0.03, -0.1)), (range(12), push)),
        objects.phase(m, 20, objects.bottom(m)),
    ]
    pair = (MATERIALS["rheological-force"], materials.rheological("gum", 150.0, 0.7, 30.0, 0.2, 0.8, 0.6))
    return objects.scene(
        m,
        pair,
        DT,
        phases,
        mass=0.01 + 0.001 * np.arange(12),
        gravity=(0.5, -9.81),
        edge_material=np.arange(len(m.edges)) % 2,
        **kwargs,
    )


def test_positions_velocities_forces_and_ratios_come_back():
    scene = mixed()
    loaded = encode(scene)
    image, units = loaded.image, loaded.units

    def half_a_bit(q, unit):
        return {"rtol": 0, "atol": 0.5001 * q.lsb * unit}

    np.testing.assert_allclose(loaded.positions(image.x), scene.mesh.points, **half_a_bit(FMT.position, units.size))
    np.testing.assert_allclose(
        loaded.velocities(image.v), scene.phases[0].velocity, **half_a_bit(FMT.velocity, units.velocity)
    )
    external = scene.phases[0].load + scene.mass[:, None] * scene.gravity
    np.testing.assert_allclose(loaded.forces(image.load), external, **half_a_bit(FMT.accumulator, units.force))
    np.testing.assert_allclose(loaded.ratios(image.ratio), scene.per_edge(lambda m: m.a0), **half_a_bit(FMT.ratio, 1))
    np.testing.assert_allclose(
        loaded.ratios(image.length),
        scene.per_edge(lambda m: m.a0)
        * lengths(scene)
        / units.size
        * 2.0 ** (FMT.length.frac_bits - FMT.ratio.frac_bits),
        rtol=2e-5,
    )


def lengths(scene):
    i, j = scene.mesh.edges.T
    return np.linalg.norm(scene.mesh.points[j] - scene.mesh.points[i], axis=1)


def test_masses_come_back_and_held_nodes_have_none():
    scene = mixed()
    loaded = encode(scene)
    for phase in scene.phases:
        loaded.start(phase, loaded.image.v)
        factor = loaded.image.inverse_mass
        value = np.ldexp(factor["value"].astype(float), -FMT.mantissa.frac_bits - factor["shift"])
        gained = np.empty(12)
        gained[loaded.node_order] = value  # velocity full scales in a step, from an accumulator at its largest
        largest = 2.0 ** (FMT.accumulator.int_bits - 1) * loaded.units.force
        expected = np.where(phase.held, 0, largest * DT / scene.mass / loaded.units.velocity)
        np.testing.assert_allclose(gained, expected, rtol=MANTISSA)


def test_a_phase_sets_the_velocities_of_held_nodes_only(rng):
    scene = mixed()
    loaded = encode(scene)
    before = rng.integers(-1000, 1000, loaded.image.v.shape)
    after = loaded.start(scene.phases[1], before)
    held = scene.phases[1].held[loaded.node_order]
    assert (after[held] == 0).all() and (after[~held] == before[~held]).all()


def test_material_coefficients_come_back():
    scene = mixed()
    loaded = encode(scene)
    units = loaded.units
    for material, record, full in zip(scene.materials, loaded.image.materials, units.trial, strict=True):

        def number(name, record=record):
            return np.ldexp(record[name] * MANTISSA, -record[f"{name}_shift"])

        assert number("k") * full / units.size == pytest.approx(material.k, rel=MANTISSA)
        assert number("c") * full / units.velocity == pytest.approx(material.c1, rel=MANTISSA)
        assert number("rho_low") == pytest.approx(1 / (1 + material.c1 / material.damper.c_max), rel=MANTISSA)
        assert number("rho_high") == pytest.approx(1 / (1 + material.c1 / material.damper.c_min), rel=MANTISSA)
        creep = 2 * full / units.velocity * 2.0 ** record["creep_shift"]
        assert number("sigma_low") == pytest.approx(creep / (material.c1 + material.damper.c_max), rel=MANTISSA)
        assert number("sigma_high") == pytest.approx(creep / (material.c1 + material.damper.c_min), rel=MANTISSA)
        for name in ("a_min", "a_max"):
            assert record[name] * FMT.ratio.lsb == pytest.approx(getattr(material, name), abs=FMT.ratio.lsb)


@given(st.floats(1e-30, 1e30))
def test_a_coefficient_has_all_its_bits(x):
    raw, shift = coefficient(x, FMT)
    assert 2 ** (FMT.mantissa.frac_bits - 1) <= raw <= FMT.mantissa.raw_max
    assert np.ldexp(raw * MANTISSA, -shift) == pytest.approx(x, rel=MANTISSA)


@pytest.mark.parametrize("half", [0.5, 2.5, 3.5])
def test_coefficients_are_rounded_half_up(half):
    """Python's own rounding takes the even integer."""
    ratio = (2**33 + half) * FMT.ratio.lsb
    up = int(2**33 + half + 0.5)
    scene = mixed()
    with_ratio = replace(scene.materials[1], a_min=ratio, a_max=ratio, a0=ratio)
    record = coefficients(with_ratio, 1, encode(scene).units, FMT, 0)[0]
    assert (record["a_min"], record["a_max"]) == (up, up)
    encoded = encode(replace(scene, materials=(with_ratio,) * len(scene.materials)))
    assert set(encoded.image.ratio.tolist()) == {up}


def test_a_coefficient_of_zero_is_zero():
    assert coefficient(0.0, FMT) == (0, 0)


@pytest.mark.parametrize("dim", [2, 3])
def test_units_are_powers_of_two_with_headroom(dim):
    for material in MATERIALS:
        scene = block(material, dim)
        units = choose(scene, FMT)
        assert all(np.frexp(full)[0] == 0.5 for full in (units.force, *units.trial))
        assert units.size == scene.size and units.dt == scene.dt
        assert units.velocity >= HEADROOM * expected_speed(scene)
        np.testing.assert_allclose(units.velocity, scene.size / scene.dt * 2.0**-units.velocity_shift, rtol=1e-15)


def test_the_image_is_in_the_encoded_order():
    scene = mixed()
    loaded = encode(scene)
    node_order, edge_order = order(scene.mesh.points, scene.mesh.edges)
    assert (loaded.node_order == node_order).all() and (loaded.edge_order == edge_order).all()
    ends = np.sort(node_order[loaded.image.edges], axis=1)
    assert (ends == scene.mesh.edges[edge_order]).all()
    assert (loaded.image.edge_material == scene.edge_material[edge_order]).all()


def test_any_order_of_nodes_gives_the_same_bits(rng):
    """Only while an edge keeps its direction: ties are rounded up, not away from zero."""
    images = [encode(mixed()).image for _ in range(2)]
    place = rng.permutation(12)  # node n becomes node place[n]
    other = images[1]
    other.edges = place[other.edges]
    for name in ("x", "v", "load"):
        moved = np.empty_like(getattr(other, name))
        moved[place] = getattr(other, name)
        setattr(other, name, moved)
    other.inverse_mass = {name: values[ranks(place)] for name, values in other.inverse_mass.items()}
    usual, renumbered = map(Machine, images)
    for machine in (usual, renumbered):
        machine.step(30)
    for name in ("x", "v", "force"):
        assert (getattr(renumbered, name)[place] == getattr(usual, name)).all()
    assert (renumbered.ratio == usual.ratio).all()
    assert (usual.x != images[0].x).any()


def test_a_renumbered_scene_gives_the_same_motion(rng):
    """Not the same bits: an edge may be taken from its other end, where its ties round the other way."""
    scene = block("rheological-force", mass=0.01)
    place = rng.permutation(12)
    points = np.empty_like(scene.mesh.points)
    points[place] = scene.mesh.points
    m = mesh.from_cells(points, place[scene.mesh.cells])
    phases = objects.press_hold_release(m, 0.008, (40, DT), 20, 30)
    other = objects.scene(m, scene.materials, DT, phases, mass=0.01, every=6)
    usual, renumbered = (run(s, "fixed").trajectory.x for s in (scene, other))
    assert np.abs(renumbered[:, place] - usual).max() <= 1e-6 * scene.size


def test_rest_is_exact():
    """Stress-free, no load: not a bit moves, whatever the material."""
    for dim, m in MESHES.items():
        for material in MATERIALS.values():
            image = encode(objects.scene(m, material, DT, [objects.phase(m, 10, objects.bottom(m))])).image
            machine = Machine(image)
            machine.step(10)
            for name in ("x", "v", "ratio"):
                assert (getattr(machine, name) == getattr(image, name)).all(), (dim, material.name, name)
            assert (machine.force == 0).all()


SPRING, FORCE = MATERIALS["rheological"], MATERIALS["rheological-force"]
HOLDS = "that the circuit can hold, beside the scene's other forces: "


def pressed(material=SPRING, mass=0.01, load=(0.0, 0.0), velocity=(0.0, -0.1), second=None):
    m = MESHES[2]
    phase = objects.phase(m, 10, objects.bottom(m), (objects.top(m), velocity), ([5], load))
    both = (material, second) if second else (material,)
    return objects.scene(m, both, DT, [phase], mass=mass, edge_material=np.arange(len(m.edges)) % len(both))


@pytest.mark.parametrize(
    "arguments, message",
    [
        (
            {"velocity": (0.0, -130.0)},
            "phases[0].driven must have velocities below 125 m/s, not 130: "
            "the circuit moves a node by less than a quarter of the object's size in a step",
        ),
        (
            {"mass": np.where(np.arange(12) == 4, 1e40, 0.01)},
            f"mass must give node 4 a factor {HOLDS}shift must be within -128 and 127 (Q8.0), not 136",
        ),
        (
            {
                "material": materials.rheological("stiff", 1e40, 0.5, 2.0),
                "second": materials.rheological("gum", 1.0, 0, 1.0),
            },
            f"materials.gum must have coefficients {HOLDS}force_shift must be within -128 and 127 (Q8.0), not ",
        ),
        (
            {"load": (1e200, 0.0)},
            "the scene must have numbers that the circuit can hold: cannot convert float infinity",
        ),
        (
            {"material": materials.rheological_force("paste", 200.0, 0.5, f1=1e-12, f2=1e-11, c_max=20.0, c_min=0.2)},
            "materials.paste.f1 and f2 must give a branch that the damper table holds "
            "(a larger f1, a longer way to f2, or c_max nearer to c_min would do): g1 must be at least ",
        ),
        (
            {"material": materials.rheological_force("glue", 200.0, 1e-3, f1=1.0, f2=1.001, c_max=20.0, c_min=0.02)},
            "materials.glue.f1 and f2 must give a branch that the damper table holds "
            "(a larger f1, a longer way to f2, or c_max nearer to c_min would do): sigma must change by less than 1/8 ",
        ),
    ],
)
def test_numbers_that_the_circuit_cannot_hold_are_refused(arguments, message):
    with np.errstate(over="ignore"), pytest.raises(InputError) as caught:
        limits.encode_checked(pressed(**arguments))
    assert str(caught.value).startswith(message) and "\n" not in str(caught.value)


def test_a_scene_within_the_limits_is_loaded_at_its_start():
    scene = mixed()
    tried, loaded = limits.encode_checked(scene).image, encode(scene).image
    for name in ("x", "v", "load", "edges", "length", "ratio"):
        assert (getattr(tried, name) == getattr(loaded, name)).all()
    assert all((tried.inverse_mass[name] == loaded.inverse_mass[name]).all() for name in ("value", "shift"))
