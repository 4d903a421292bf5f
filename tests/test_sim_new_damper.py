"""A damper law that this project doesn't have: a class is all that it takes to run it."""

from dataclasses import dataclass, replace

import golden_objects as objects
import numpy as np
import pytest
from sim_objects import MATERIALS, block

from golden.physics import stability
from golden.physics.dampers import Damper
from golden.scene import archive
from golden.support.errors import InputError
from sim.results import energy, ranges
from sim.results.comparison import BOUND
from sim.run import run


@dataclass(frozen=True)
class PowerLaw(Damper):
    """c2 = c_max up to f1, then c_max (1 + (f - f1) / f0)^-n, but never less than c_min."""

    c_max: float
    c_min: float
    f1: float
    f0: float
    n: float

    @property
    def f2(self) -> float:
        return self.f1 + self.f0 * ((self.c_max / self.c_min) ** (1 / self.n) - 1)

    def fall(self, f):
        return self.n * np.log1p((f - self.f1) / self.f0)

    def fall_rate(self, f):
        return self.n / (self.f0 + f - self.f1)


LAW = PowerLaw(c_max=200.0, c_min=2.0, f1=0.02, f0=0.03, n=2.0)


def scene(**changes):
    """A block of this law, pressed, held and released."""
    material = replace(MATERIALS["rheological-force"], damper=LAW)
    return replace(block("rheological-force", every=3), materials=(material,), **changes)


def test_its_coefficients_are_the_formula():
    f = np.array([0.0, 0.01, 0.02, 0.05, 0.1, 0.2, LAW.f2 / 2, LAW.f2, 3.0])
    expected = np.maximum(200.0 * (1 + np.maximum(f - 0.02, 0) / 0.03) ** -2.0, 2.0)
    np.testing.assert_allclose(LAW.c2(f), expected, rtol=1e-13)
    rho, sigma = LAW.rho_sigma(0.5, f * (1 + 0.5 / expected))
    np.testing.assert_allclose(rho / sigma, expected, rtol=1e-12)


def test_float_and_fixed_agree():
    object_ = scene()
    exact, fixed = (run(object_, backend) for backend in ("float", "fixed"))
    forces = np.abs(energy.edge_forces(object_, exact.trajectory))
    assert (forces.max(axis=0) > LAW.f2).any() and ((LAW.f1 < forces) & (forces < LAW.f2)).any()  # in all branches
    difference = np.linalg.norm(fixed.trajectory.x - exact.trajectory.x, axis=2).max() / object_.size
    print(f"largest |dx| {difference:.2g} of the size")
    assert object_.force_dependent and difference <= BOUND[True]


def test_the_largest_step_follows_from_its_slope():
    """An edge between held nodes, without c1: its ratio yields fastest just below f2, by k d(f / c2) / df."""
    mesh, f = objects.line(), LAW.f2 - np.array([0.0, 1e-7])
    material = replace(MATERIALS["rheological"], c1=0.0, damper=LAW)
    edge = objects.scene(mesh, material, 1.0, [objects.phase(mesh, 1, [0, 1])])
    yielding = -np.diff(f / LAW.c2(f))[0] / 1e-7
    bound = stability.HALF_DISC * stability.TURNING / (material.k * yielding)
    assert stability.largest_dt(edge)[0] == pytest.approx(bound, rel=1e-4)


def test_a_step_too_large_for_it_is_refused():
    object_ = scene()
    stability.check(object_)
    with pytest.raises(InputError, match=r"^dt must be at most .* of the material 'dough' on these masses limits it$"):
        stability.check(replace(object_, dt=2 * stability.largest_dt(object_)[0]))


def test_energies_ranges_and_archive(tmp_path):
    object_ = scene()
    result = run(object_, "fixed")
    assert all(np.isfinite(part).all() for part in energy.energies(object_, result.trajectory).values())
    assert {entry["quantity"] for entry in ranges.measure(object_, result.raw)} >= {"rho", "sigma"}
    archive.save(object_, tmp_path / "scene.npz")
    assert archive.load(tmp_path / "scene.npz").materials == object_.materials
