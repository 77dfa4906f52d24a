"""Procedures over solids of revolution, one by one beside a closed form."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

E, NU, RHO = 206e3, 0.3, 7.8e-9


def thin_ring(element: str = "Q8", cell: str = "quad8") -> ct.Model:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 2, 2, cell=cell))
    model.mesh.points[:, 0] += 99.5
    steel = ct.Elastic(E, NU, rho=RHO)
    model.section("all", element=element, material=steel, plane="axisymmetric")
    return model


def test_a_thin_ring_breathes_with_its_frequency() -> None:
    """sqrt(E / rho) / R; the mode before it is the ring that rolls."""
    model = thin_ring()
    model.fix([0], x=None)
    factors = ct.solve(model, ct.Frequency(modes=2), threads=1).modes[0].factors
    assert factors[1] == pytest.approx(np.sqrt(E / RHO) / 100.0 / (2.0 * np.pi), rel=1e-4)


@pytest.mark.filterwarnings("ignore:central differences took")
@pytest.mark.parametrize("scheme", ["newmark", "energy_momentum", "central_difference"])
def test_a_breathing_ring_keeps_energy_and_period(scheme: str) -> None:
    """Released with a radial velocity: the displacement is v / omega sin(omega t)."""
    model = thin_ring("Q4", "quad4")
    omega, velocity = np.sqrt(E / RHO) / 100.0, 100.0
    model.velocity("", x=velocity)
    quarter = 0.5 * np.pi / omega
    step = ct.Dynamic(period=quarter, scheme=scheme, increments=0 if "central" in scheme else 50)
    frame = ct.solve(model, step, threads=1).frames[-1]
    assert frame.U[:, 0].mean() == pytest.approx(velocity / omega, rel=2e-3)
    kinetic = 0.5 * velocity**2 * RHO * np.pi * (100.5**2 - 99.5**2)
    assert frame.scalars["strain energy"] == pytest.approx(kinetic, rel=2e-3)


def cone(height: float, thickness: float) -> tuple[ct.Model, int, int]:
    """Disc spring 50 / 25.4 with a straight cone; nodes of its upper inner, lower outer edge."""
    inner, width = 12.7, 25.0 - 12.7
    mesh = ct.mesh.rectangle(width, thickness, 24, 2, cell="quad8")
    length = float(np.hypot(width, height))
    c, s = width / length, height / length
    along, across = mesh.points[:, 0] * length / width, mesh.points[:, 1] - 0.5 * thickness
    upper = int(np.argmin(along - across))
    lower = int(np.argmax(along - across))
    mesh.points[:] = np.stack(
        [inner + along * c + across * s, height - along * s + across * c], axis=1
    )
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=ct.Elastic(E, NU), plane="axisymmetric")
    return model, upper, lower


@pytest.mark.parametrize(("height", "thickness"), [(1.6, 1.25), (2.2, 1.0)])
def test_a_disc_spring_lies_below_almen_and_laszlo(height: float, thickness: float) -> None:
    """Their section turns without deformation under plane-strain stiffness E / (1 - nu^2).

    That bounds the force from above; 5 to 12 percent is what the free section gives back.
    """
    model, upper, lower = cone(height, thickness)
    model.fix([lower], x=None)
    step = ct.Static(increments=4)
    step.fix([upper], x=None, y=-height)
    frames = ct.solve(model, step, threads=1).frames[1:]
    d = 50.0 / 25.4
    k = ((d - 1.0) / d) ** 2 / (np.pi * ((d + 1.0) / (d - 1.0) - 2.0 / np.log(d)))
    for frame in frames:
        s = -frame.U[upper, 1]
        plate = 4.0 * E / (1.0 - NU**2) * thickness**3 / (k * 50.0**2) * s
        curve = (height - s) * (height - 0.5 * s) / thickness**2 + 1.0
        ratio = -frame.RF[upper, 1] / (plate * curve)
        assert 0.88 < ratio < 0.95


def test_a_steep_disc_spring_has_a_limit_point() -> None:
    """The path under a force passes its maximum: h0 / t = 2.2 exceeds sqrt 2."""
    model, upper, lower = cone(2.2, 1.0)
    model.fix([lower], x=None)
    model.force([upper], y=-2000.0)
    path = ct.ArcLength(displacement=(upper, "y", -2.0))
    results = ct.solve(model, ct.Static(path=path, increments=8), threads=1)
    kinds = [point.kind for point in results.critical_points]
    assert "limit" in kinds


def test_a_cylinder_buckles_at_the_classical_stress_and_at_half_of_it_from_a_free_edge() -> None:
    """E t / (R sqrt(3 (1 - nu^2))); a free edge halves it (Nachbar and Hoff 1962)."""
    mesh = ct.mesh.rectangle(1.0, 60.0, nx=2, ny=120, cell="quad8")
    mesh.points[:, 0] += 99.5
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=ct.Elastic(E, NU), plane="axisymmetric")
    model.fix("bottom", x=None)
    model.traction("top", y=-1.0)
    factors = ct.solve(model, ct.Buckle(modes=2), threads=1).modes[0].factors
    classical = E * 1.0 / (100.0 * np.sqrt(3.0 * (1.0 - NU**2)))
    assert factors[0] == pytest.approx(0.5 * classical, rel=5e-3)
    assert factors[1] == pytest.approx(classical, rel=0.05)  # the length holds few waves


def test_an_initial_stress_relaxes_in_one_increment() -> None:
    """Radial and hoop stress s in a free ring: u = -s (1 - nu) r / E."""
    mesh = ct.mesh.rectangle(10.0, 5.0, nx=4, ny=2, cell="quad8")
    mesh.points[:, 0] += 10.0
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=ct.Elastic(E, NU), plane="axisymmetric")
    model.fix("bottom", x=None)
    model.initial_stress("all", xx=100.0, zz=100.0)
    results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    found = results.history("U1", at="right")[-1]
    assert found == pytest.approx(-100.0 * (1.0 - NU) * 20.0 / E, rel=1e-10)
