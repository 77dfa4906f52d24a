"""Axisymmetric bodies beside closed forms, all derived by hand or taken from the named books."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.model import elements

NAMES = [name for name in elements.names() if elements.find(name).revolved]
QUADRATIC = ("T6", "Q8", "Q8R", "Q9")
E, NU = 210000.0, 0.3
A, B, P = 100.0, 200.0, 100.0


def linear(model: ct.Model) -> ct.Results:
    return ct.solve(model, ct.Static(nlgeom=False), threads=1)


def sphere(element: str, n: int, material: Any = None, **options: Any) -> ct.Model:
    """Half of a hollow sphere between its middle plane and the axis."""
    cell = elements.find(element).cell
    model = ct.Model(ct.mesh.annulus(A, B, n, 2 * n, angle=90.0, cell=cell))
    material = material or ct.Elastic(E=E, nu=NU)
    model.section("all", element=element, material=material, plane="axisymmetric", **options)
    model.fix("start", x=None)
    return model


def sphere_error(element: str, n: int) -> float:
    model = sphere(element, n)
    model.pressure("inner", P)
    u = linear(model).frames[-1].U
    worst = 0.0
    for name, r in (("inner", A), ("outer", B)):
        nodes = model.mesh.node_sets[name]
        x = model.mesh.points[nodes]
        radial = (u[nodes, :2] * x).sum(axis=1) / np.hypot(*x.T)
        # Timoshenko and Goodier, Theory of Elasticity, art. 136.
        c = P * A**3 / (E * (B**3 - A**3))
        exact = c * ((1.0 - 2.0 * NU) * r + 0.5 * (1.0 + NU) * B**3 / r**2)
        # The mean leaves the error of the interpolation between nodes out.
        worst = max(worst, abs(float(radial.mean()) / exact - 1.0))
    return worst


@pytest.mark.parametrize("element", NAMES)
def test_lame_sphere_converges(element: str) -> None:
    """Displacements converge by the order of the shape functions and one, or more."""
    order, n = (3 if element in QUADRATIC else 2), 4
    coarse, fine = sphere_error(element, n), sphere_error(element, 2 * n)
    assert np.log2(coarse / fine) > order - 0.3
    assert fine < (1e-4 if order == 3 else 0.015)


@pytest.mark.parametrize("element", NAMES)
def test_lame_cylinder(element: str) -> None:
    """Pressed ring held along its axis: displacement, hoop stress and axial force."""
    cell = elements.find(element).cell
    model = ct.Model(ct.mesh.rectangle(B - A, 10.0, nx=32, ny=2, cell=cell))
    model.mesh.points[:, 0] += A
    model.section("all", element=element, material=ct.Elastic(E=E, nu=NU), plane="axisymmetric")
    model.fix("bottom", x=None)
    model.fix("top", x=None)
    model.pressure("left", P)
    frame = linear(model).frames[-1]
    c = P * A**2 / (E * (B**2 - A**2)) * (1.0 + NU)
    for name, r in (("left", A), ("right", B)):
        exact = c * ((1.0 - 2.0 * NU) * r + B**2 / r)
        assert frame.U[model.mesh.node_sets[name], 0].mean() == pytest.approx(exact, rel=1.5e-3)
    # Stress along the axis is uniform: 2 nu times the mean of both others.
    axial = 2.0 * NU * P * A**2 / (B**2 - A**2) * np.pi * (B**2 - A**2)
    top = frame.RF[model.mesh.node_sets["top"], 1].sum()
    assert top == pytest.approx(axial, rel=2e-3)


@pytest.mark.parametrize("element", ["Q4I", "Q8", "T6"])
def test_spinning_cylinder(element: str) -> None:
    """Solid long cylinder held along its axis, omega = 300 (Timoshenko and Goodier, art. 32)."""
    cell = elements.find(element).cell
    model = ct.Model(ct.mesh.rectangle(B, 10.0, nx=24, ny=2, cell=cell))
    rho, omega = 7.8e-9, 300.0
    steel = ct.Elastic(E=E, nu=NU, rho=rho)
    model.section("all", element=element, material=steel, plane="axisymmetric")
    model.fix("bottom", x=None)
    model.fix("top", x=None)
    model.centrifugal(omega=omega)
    frame = linear(model).frames[-1]
    k = (1.0 + NU) * (1.0 - 2.0 * NU) / (8.0 * E * (1.0 - NU)) * rho * omega**2
    exact = k * B * ((3.0 - 2.0 * NU) * B**2 - B**2)
    tip = frame.U[model.mesh.node_sets["right"], 0].mean()
    assert tip == pytest.approx(exact, rel=1e-3)
    assert np.abs(frame.U[model.mesh.node_sets["left"], 0]).max() == 0.0


def test_weight_and_mass_are_of_the_whole_circumference() -> None:
    model = ct.Model(ct.mesh.rectangle(2.0, 3.0, nx=4, ny=4, cell="quad8"))
    model.mesh.points[:, 0] += 1.0
    model.section("all", element="Q8", material=ct.Elastic(1e3, 0.3, rho=2.0), plane="axisymmetric")
    model.fix("bottom", x=None)
    model.gravity(y=-10.0)
    frame = linear(model).frames[-1]
    weight = 10.0 * 2.0 * np.pi * (3.0**2 - 1.0) * 3.0
    assert frame.RF[:, 1].sum() == pytest.approx(weight, rel=1e-12)
    model = ct.Model(model.mesh)
    model.section("all", element="Q8", material=ct.Elastic(1e3, 0.3), plane="axisymmetric")
    model.fix("bottom", x=None)
    model.traction("top", y=5.0)
    assert linear(model).frames[-1].RF[:, 1].sum() == pytest.approx(-5.0 * 8.0 * np.pi, rel=1e-12)


def test_free_heating_is_free_of_stress() -> None:
    steel = ct.Elastic(E=E, nu=NU, expansion=1e-5)
    for element in ("Q4I", "Q8R", "T3"):
        model = sphere(element, 3, steel)
        model.temperature(100.0)
        frame = linear(model).frames[-1]
        np.testing.assert_allclose(frame.U[:, :2], 1e-3 * model.mesh.points, atol=1e-12)
        for fields in frame.fields:
            assert np.abs(fields.values["S"]).max() < 1e-7


#: Hill, The Mathematical Theory of Plasticity, ch. V.2: front, pressure, outer displacement.
HILL = [(110.0, 179.128886, 0.02662), (140.0, 266.626674, 0.05488), (180.0, 325.497599, 0.11664)]


@pytest.mark.parametrize("element", ["Q4I", "Q8R"])
@pytest.mark.parametrize(("front", "pressure", "expected"), HILL)
def test_hill_sphere_in_one_increment(
    element: str, front: float, pressure: float, expected: float
) -> None:
    steel = ct.Mises(E=E, nu=NU, yield_stress=240.0)
    n = 32 if element == "Q4I" else 16
    model = sphere(element, n, steel, local_strain="linear")
    model.pressure("inner", pressure)
    step = ct.Static(nlgeom=False, increments=1)
    frame = ct.solve(model, step, threads=1).frames[-1]
    nodes = model.mesh.node_sets["outer"]
    x = model.mesh.points[nodes]
    found = float(((frame.U[nodes, :2] * x).sum(axis=1) / B).mean())
    assert found == pytest.approx(expected, rel=5e-3)


def test_hill_sphere_collapses() -> None:
    """Plateau at 2 sy ln(b / a); at finite displacements a limit point, with the radii there."""
    steel = ct.Mises(E=E, nu=NU, yield_stress=240.0)
    for nlgeom in (False, True):
        model = sphere("Q8R", 6, steel)
        model.pressure("inner", 100.0)
        inside, outside = model.mesh.node_sets["inner"], model.mesh.node_sets["outer"]
        end = int(inside[np.argmin(model.mesh.points[inside, 1])])
        path = ct.ArcLength(displacement=(end, "x", 1.5))
        results = ct.solve(model, ct.Static(nlgeom=nlgeom, path=path, increments=20), threads=1)
        pressure = 100.0 * max(f.factor for f in results.frames)
        if not nlgeom:
            assert pressure == pytest.approx(332.710647, rel=2e-5)
            assert 100.0 * results.frames[-1].factor == pytest.approx(pressure, rel=1e-6)
            continue
        limit = next(p for p in results.critical_points if p.kind == "limit")
        assert 100.0 * limit.factor == pytest.approx(pressure, rel=1e-9)
        frame = max(results.frames, key=lambda f: f.factor)
        a = A + float(frame.U[end, 0])
        b = B + float(np.hypot(*frame.U[outside, :2].T).mean())
        assert pressure == pytest.approx(480.0 * np.log(b / a), rel=1e-3)


def test_neo_hooke_balloon_through_its_maximum() -> None:
    """A = 1, B = 2, constant volume: pressure over the shear modulus by the stretch inside."""
    rubber = ct.NeoHooke(C10=0.5, D1=2e-5)
    cell = elements.find("Q8R").cell
    model = ct.Model(ct.mesh.annulus(1.0, 2.0, 6, 8, angle=90.0, cell=cell))
    model.section("all", element="Q8R", material=rubber, plane="axisymmetric")
    model.fix("start", x=None)
    model.pressure("inner", 1.0)
    inside = model.mesh.node_sets["inner"]
    end = int(inside[np.argmin(model.mesh.points[inside, 1])])
    path = ct.ArcLength(displacement=(end, "x", 2.05), locate=False)
    results = ct.solve(model, ct.Static(path=path, increments=10), threads=1)
    stretch = [1.0 + float(np.hypot(*(f.U[inside, :2]).T).mean()) for f in results.frames]
    factor = [f.factor for f in results.frames]
    assert max(stretch) > 3.0
    assert max(factor) == pytest.approx(0.8164236, abs=1e-3)
    for a, p in zip(stretch, factor, strict=True):
        b = (8.0 - 1.0 + a**3) ** (1.0 / 3.0) / 2.0
        exact = 2.0 / b + 0.5 / b**4 - 2.0 / a - 0.5 / a**4
        assert p == pytest.approx(exact, abs=1e-3)
