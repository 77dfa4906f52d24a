"""Audit of solids of revolution from closed forms alone: 30 checks of stresses, flow, rubber.

Written from the documents, without a look at the core. Each check names its source; all are in
default settings unless the closed form is of infinitesimal displacements.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.verification.contact_models import quarter

E, NU, RHO, ALPHA = 210e3, 0.3, 7.8e-9, 1.2e-5
STEEL = ct.Elastic(E, NU, rho=RHO, expansion=ALPHA)
LINEAR = ct.Static(nlgeom=False)


def ring(
    inner: float,
    outer: float,
    height: float,
    nx: int = 20,
    ny: int = 2,
    material: Any = STEEL,
    element: str = "Q8",
    **options: Any,
) -> ct.Model:
    """Rectangle turned about the axis."""
    cell = "quad8" if element.startswith("Q8") else "quad4"
    mesh = ct.mesh.rectangle(outer - inner, height, nx, ny, cell=cell)
    mesh.points[:, 0] += inner
    model = ct.Model(mesh)
    model.section("all", element=element, material=material, plane="axisymmetric", **options)
    return model


def ball(
    inner: float, outer: float, n: int = 12, material: Any = STEEL, **options: Any
) -> ct.Model:
    """Half of a hollow sphere between its middle plane and the axis."""
    model = ct.Model(ct.mesh.annulus(inner, outer, n, 2 * n, angle=90.0, cell="quad8"))
    model.section("all", element="Q8R", material=material, plane="axisymmetric", **options)
    model.fix("start", x=None)
    return model


def solve(model: ct.Model, step: Any = LINEAR) -> ct.Results:
    return ct.solve(model, step, threads=1)


def at(results: ct.Results, name: str, x: float, y: float | None = None) -> float:
    """Mean nodal value at a radius, or the value at a place."""
    points = results.model.mesh.points
    near = np.abs(points[:, 0] - x) < 1e-9
    if y is not None:
        near &= np.abs(points[:, 1] - y) < 1e-9
    return float(results.nodal(name)[near].mean())


def radial(results: ct.Results, where: str) -> float:
    """Mean displacement along the radius vector of a sphere."""
    nodes = results.model.mesh.node_sets[where]
    x = results.model.mesh.points[nodes]
    return float(((results.frames[-1].U[nodes, :2] * x).sum(axis=1) / np.hypot(*x.T)).mean())


# Rotation: Timoshenko and Goodier, Theory of Elasticity, art. 32.
def test_rotating_disc_with_a_hole() -> None:
    a, b, w = 50.0, 200.0, 500.0
    model = ring(a, b, 1.0, nx=40, ny=1)
    model.fix("bottom", x=None)
    model.centrifugal(omega=w)
    results = solve(model)
    hoop = (3.0 + NU) / 4.0 * RHO * w**2 * (b**2 + (1.0 - NU) / (3.0 + NU) * a**2)
    assert at(results, "U1", a) == pytest.approx(a * hoop / E, rel=1e-3)
    assert at(results, "S33", a) == pytest.approx(hoop, rel=1e-2)


def test_rotating_solid_disc() -> None:
    b, w = 200.0, 500.0
    model = ring(0.0, b, 1.0, nx=30, ny=1)
    model.fix("bottom", x=None)
    model.centrifugal(omega=w)
    results = solve(model)
    center = (3.0 + NU) / 8.0 * RHO * w**2 * b**2
    assert at(results, "S11", 0.0) == pytest.approx(center, rel=2e-3)
    assert at(results, "S33", 0.0) == pytest.approx(center, rel=2e-3)
    rim = (1.0 - NU) * RHO * w**2 * b**3 / (4.0 * E)
    assert at(results, "U1", b) == pytest.approx(rim, rel=1e-3)


def test_rotating_free_long_tube_shortens() -> None:
    """The mean of radial and hoop stress is rho w^2 (a^2 + b^2) / 4 by the virial."""
    a, b, w, h = 50.0, 100.0, 700.0, 10.0
    model = ring(a, b, h)
    model.fix("bottom", x=None)
    top = model.mesh.node_sets["top"]
    for node in top[1:]:
        model.equation((int(node), "y", 1.0), (int(top[0]), "y", -1.0))
    model.centrifugal(omega=w)
    results = solve(model)
    shorter = -NU * RHO * w**2 * (a**2 + b**2) / (2.0 * E) * h
    assert results.frames[-1].U[top, 1] == pytest.approx(shorter, rel=1e-6)


# Heat: Timoshenko and Goodier, art. 150 to 153.
def test_disc_with_a_parabola_of_temperature() -> None:
    b = 100.0
    model = ring(0.0, b, 1.0, nx=30, ny=1)
    model.fix("bottom", x=None)
    model.temperature(80.0 * (1.0 - (model.mesh.points[:, 0] / b) ** 2))
    results = solve(model)
    assert at(results, "S11", 0.0) == pytest.approx(-E * ALPHA * 80.0 / 4.0, rel=5e-3)
    assert at(results, "S33", b) == pytest.approx(E * ALPHA * 80.0 / 2.0, rel=5e-3)
    assert at(results, "U1", b) == pytest.approx(ALPHA * 80.0 * b / 2.0, rel=1e-4)


def test_tube_with_a_logarithm_of_temperature() -> None:
    a, b, heat, h = 50.0, 100.0, 60.0, 10.0
    model = ring(a, b, h, nx=30)
    model.fix("bottom", x=None)
    top = model.mesh.node_sets["top"]
    for node in top[1:]:
        model.equation((int(node), "y", 1.0), (int(top[0]), "y", -1.0))
    model.temperature(heat * np.log(b / model.mesh.points[:, 0]) / np.log(b / a))
    results = solve(model)
    log = np.log(b / a)
    factor = E * ALPHA * heat / (2.0 * (1.0 - NU) * log)
    assert at(results, "S33", a) == pytest.approx(
        factor * (1.0 - 2.0 * b**2 / (b**2 - a**2) * log), rel=5e-3
    )
    assert at(results, "S33", b) == pytest.approx(
        factor * (1.0 - 2.0 * a**2 / (b**2 - a**2) * log), rel=5e-3
    )


def test_hollow_sphere_with_radial_heat_flow() -> None:
    """u(b) = 3 alpha b / (b^3 - a^3) times the integral of T r^2."""
    a, b = 50.0, 100.0
    model = ball(a, b)
    r = np.hypot(*model.mesh.points.T)
    model.temperature(100.0 * (1.0 / r - 1.0 / b) / (1.0 / a - 1.0 / b))
    results = solve(model)
    c = 100.0 / (1.0 / a - 1.0 / b)
    integral = c * ((b**2 - a**2) / 2.0 - (b**3 - a**3) / (3.0 * b))
    exact = 3.0 * ALPHA * b / (b**3 - a**3) * integral
    assert radial(results, "outer") == pytest.approx(exact, rel=5e-4)


def test_ring_on_a_rigid_shaft_that_cools() -> None:
    """Thin disc shrunk by alpha T on a fixed bore: Lame's stiffness against outward motion."""
    a, b, cold = 50.0, 80.0, -50.0
    model = ring(a, b, 1.0, ny=1)
    model.fix("bottom", x=None)
    model.fix("left", x=0.0, y=None)
    model.temperature(cold)
    results = solve(model)
    pressure = -E * ALPHA * cold / ((b**2 + a**2) / (b**2 - a**2) + NU)
    found = results.frames[-1].RF[model.mesh.node_sets["left"], 0].sum()
    assert found == pytest.approx(pressure * 2.0 * np.pi * a * 1.0, rel=1e-4)


# Homogeneous and layered bodies.
def test_solid_sphere_under_pressure_all_around() -> None:
    mesh = ct.mesh.annulus(1e-3, 50.0, 16, 16, angle=90.0, cell="quad8")
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=STEEL, plane="axisymmetric")
    model.fix("start", x=None)
    model.pressure("outer", 1000.0)
    model.pressure("inner", 1000.0)
    results = solve(model)
    exact = -1000.0 * (1.0 - 2.0 * NU) * 50.0 / E
    # The curved sides are parabolas.
    assert radial(results, "outer") == pytest.approx(exact, rel=5e-5)


def test_hollow_sphere_under_outer_pressure() -> None:
    """u(a) = -3 p (1 - nu) a b^3 / 2 E (b^3 - a^3)."""
    a, b = 60.0, 100.0
    model = ball(a, b)
    model.pressure("outer", 100.0)
    exact = -150.0 * (1.0 - NU) * a * b**3 / (E * (b**3 - a**3))
    assert radial(solve(model), "inner") == pytest.approx(exact, rel=1e-4)


def test_two_loads_are_reciprocal() -> None:
    """Betti: ring forces and pressure do the same work on the displacements of one another."""
    found = []
    for loaded in (True, False):
        model = ring(20.0, 60.0, 30.0, nx=12, ny=9)
        model.fix("bottom", x=None)
        edge = int(np.argmax(model.mesh.points.sum(axis=1)))
        if loaded:
            model.force([edge], x=3000.0, y=-2000.0)
        else:
            model.pressure("left", 50.0)
        found.append(solve(model).frames[-1])
    bore = model.mesh.node_sets["left"]
    y, order = model.mesh.points[bore, 1], np.argsort(model.mesh.points[bore, 1])
    u = found[0].U[bore[order], 0]
    # Simpson's rule over the quadratic edges is exact.
    h = np.diff(y[order])[0]
    integral = h / 3.0 * (u[:-2:2] + 4.0 * u[1:-1:2] + u[2::2]).sum()
    work = 50.0 * 2.0 * np.pi * 20.0 * integral
    other = 3000.0 * found[1].U[edge, 0] - 2000.0 * found[1].U[edge, 1]
    assert work == pytest.approx(other, rel=1e-9)


def test_solid_cylinder_under_dead_ring_forces() -> None:
    """Nodal forces of the whole circumference give the mean stress far from the end."""
    model = ring(0.0, 10.0, 60.0, nx=8, ny=24)
    model.fix("bottom", x=None)
    edge = int(np.argmax(model.mesh.points.sum(axis=1)))
    model.force([edge], y=31415.92653589793)
    results = solve(model)
    assert at(results, "S22", 0.0, 20.0) == pytest.approx(100.0, rel=2e-3)
    assert at(results, "U1", 10.0, 20.0) == pytest.approx(-NU * 100.0 / E * 10.0, rel=2e-3)


def test_ring_pulled_by_radial_forces() -> None:
    """Thin ring: line load q = F / (2 pi R) gives u = q R^2 / (E A)."""
    model = ring(99.5, 100.5, 1.0, nx=2, ny=2)
    model.fix("bottom", x=None)
    nodes = np.flatnonzero(np.abs(model.mesh.points[:, 0] - 100.0) < 1e-9)
    model.force(nodes, x=6283.185307179586, total=True)
    results = solve(model)
    assert at(results, "U1", 100.0) == pytest.approx(10.0 * 100.0**2 / E, rel=1e-3)


def test_two_materials_share_a_pressure() -> None:
    """Steel ring on an aluminium one, thin and free along the axis, pressed from inside."""
    a, c, b, soft, nu2 = 40.0, 50.0, 65.0, 70e3, 0.33
    model = ring(a, b, 0.5, nx=25, ny=1)
    radius = model.mesh.points[model.mesh.cells[0].nodes].mean(axis=1)[:, 0]
    model.mesh.cell_sets["in"], model.mesh.cell_sets["out"] = (
        np.flatnonzero(radius < c),
        np.flatnonzero(radius > c),
    )
    model = ct.Model(model.mesh)
    model.section("in", element="Q8", material=ct.Elastic(soft, nu2), plane="axisymmetric")
    model.section("out", element="Q8", material=STEEL, plane="axisymmetric")
    model.fix("bottom", x=None)
    model.pressure("left", 100.0)
    results = solve(model)
    k = c**2 - a**2
    flexible = c / soft * ((c**2 + a**2) / k - nu2) + c / E * ((b**2 + c**2) / (b**2 - c**2) + NU)
    shared = 100.0 * 2.0 * a**2 * c / (soft * k) / flexible
    outside = 2.0 * shared * c**2 * b / (E * (b**2 - c**2))
    assert at(results, "U1", b) == pytest.approx(outside, rel=2e-3)


def test_orthotropic_ring() -> None:
    """Powers of r with the exponents -1 and +-sqrt(E_hoop / E_radial) (Lekhnitskii)."""
    a, b, p, soft, stiff = 50.0, 100.0, 10.0, 10e3, 40e3
    wood = ct.Orthotropic(soft, soft, stiff, 0.0, 0.0, 0.0, 5e3)
    model = ring(a, b, 1.0, nx=40, ny=1, material=wood)
    model.fix("bottom", x=None)
    model.pressure("left", p)
    results = solve(model)
    k = np.sqrt(stiff / soft)
    m = np.array([[a ** (k - 1.0), a ** (-k - 1.0)], [b ** (k - 1.0), b ** (-k - 1.0)]])
    c, d = np.linalg.solve(m, [-p, 0.0])
    for r in (a, b):
        hoop = k * (c * r ** (k - 1.0) - d * r ** (-k - 1.0))
        assert at(results, "U1", r) == pytest.approx(hoop * r / stiff, rel=2e-3)


# Pressure as a load.
def test_a_dome_carries_the_pressure_on_its_plan() -> None:
    """Vertical force of an inner pressure on half a sphere: p pi a^2, whatever moves."""
    model = ball(90.0, 100.0, 4)
    model.pressure("inner", 20.0)
    found = solve(model, ct.Static()).frames[-1].RF[model.mesh.node_sets["start"], 1].sum()
    u = radial(solve(model, ct.Static()), "inner")
    assert found == pytest.approx(-20.0 * np.pi * (90.0 + u) ** 2, rel=2e-4)


def test_water_pressure_all_around_is_in_balance() -> None:
    """A body of any section under the same pressure everywhere has no reaction."""
    mesh = ct.mesh.mapped([(10.0, 0.0), (22.0, 3.0), (18.0, 14.0), (7.0, 11.0)], 8, 8)
    model = ct.Model(mesh)
    soft = ct.Elastic(1000.0, 0.3)
    model.section("all", element="Q4I", material=soft, plane="axisymmetric")
    for side in ("left", "right", "top", "bottom"):
        model.pressure(side, 50.0)
    model.fix([0], x=None)
    frame = solve(model, ct.Static(increments=1)).frames[-1]
    assert abs(frame.RF[0, 1]) < 1e-6 * 50.0 * np.pi * 22.0**2


def test_dead_and_following_traction_on_a_rim() -> None:
    """Axial force of a traction on a top that grows: 2 pi of its reference, or current, area."""
    for follow in (False, True):
        model = ring(10.0, 20.0, 10.0, nx=6, ny=6, material=ct.Elastic(1e4, 0.3))
        model.fix("bottom", x=None)
        model.traction("top", y=-100.0, follow=follow)
        results = solve(model, ct.Static())
        force = results.frames[-1].RF[:, 1].sum()
        grown = 1.0
        if follow:
            top = model.mesh.node_sets["top"]
            x = model.mesh.points[top, 0] + results.frames[-1].U[top, 0]
            grown = (x.max() ** 2 - x.min() ** 2) / 300.0
        assert force == pytest.approx(100.0 * np.pi * 300.0 * grown, rel=1e-3)


# Flow without hardening: Hill, The Mathematical Theory of Plasticity, ch. V.
IDEAL = ct.Mises(E, NU, yield_stress=240.0)


def test_first_yield_of_a_hollow_sphere() -> None:
    """p = 2/3 sy (1 - a^3 / b^3): nothing has flowed just below, something just above."""
    exact = 2.0 / 3.0 * 240.0 * (1.0 - 1.0 / 8.0)
    for share, flows in ((0.97, False), (1.06, True)):
        model = ball(100.0, 200.0, 16, IDEAL)
        model.pressure("inner", share * exact)
        results = solve(model, ct.Static(nlgeom=False, increments=1))
        assert (results.frames[-1].fields[0].values["PEEQ"].max() > 0.0) == flows


def test_residual_stress_of_a_sphere() -> None:
    """Front at 140, then unloaded: sy - p - p (b^3 + 2 a^3) / 2 (b^3 - a^3) around the bore."""
    model = ball(100.0, 200.0, 16, IDEAL)
    model.pressure("inner", 266.626674)
    empty = ct.Static(nlgeom=False)
    empty.pressure("inner", 0.0)
    results = solve(model, [LINEAR, empty])
    nodes = results.model.mesh.node_sets["inner"]
    hoop = results.nodal("S33")[nodes].mean()
    assert hoop == pytest.approx(240.0 - 266.626674 * (1.0 + 10.0 / 14.0), rel=0.03)


def test_collapse_of_a_long_tube() -> None:
    """Plane strain: 2 sy / sqrt(3) ln(b / a)."""
    model = ring(50.0, 100.0, 10.0, nx=16, ny=1, material=IDEAL, element="Q8R")
    model.fix("bottom", x=None)
    model.fix("top", x=None)
    model.pressure("left", 100.0)
    inside = int(model.mesh.node_sets["left"][0])
    path = ct.ArcLength(displacement=(inside, "x", 1.0))
    results = solve(model, ct.Static(nlgeom=False, path=path))
    exact = 2.0 / np.sqrt(3.0) * 240.0 * np.log(2.0)
    assert 100.0 * results.frames[-1].factor == pytest.approx(exact, rel=1e-3)


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4S", "Q4R", "Q8", "Q8R"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_pulled_cylinder_without_hardening(element: str, sign: float) -> None:
    """The force stays sy A past yield, in one large increment."""
    model = ring(0.0, 10.0, 20.0, nx=3, ny=4, material=IDEAL, element=element)
    model.fix("bottom", x=None)
    step = ct.Static(nlgeom=False)
    step.fix("top", x=None, y=sign * 0.2)
    force = solve(model, step).frames[-1].RF[model.mesh.node_sets["top"], 1].sum()
    assert force == pytest.approx(sign * 240.0 * np.pi * 100.0, rel=1e-6)


def test_thin_ring_that_flows_under_pressure() -> None:
    """Linear hardening H: hoop stress s = p R / t, strain s / E + (s - sy) / H."""
    hard = ct.Mises(E, NU, yield_stress=240.0, isotropic=10e3)
    model = ring(99.5, 100.5, 0.5, nx=2, ny=1, material=hard)
    model.fix("bottom", x=None)
    model.pressure("left", 300.0 / 99.5)
    results = solve(model, ct.Static(nlgeom=False, increments=1))
    # The radial stress, -p / 2 in the mean, adds p / 4 to that of von Mises.
    exact = 100.0 * (300.0 / E + (60.0 + 0.25 * 300.0 / 99.5) / 10e3)
    assert at(results, "U1", 100.0) == pytest.approx(exact, rel=1e-3)


def test_cylinder_that_is_upset_without_hardening() -> None:
    """To .8 of its height: the force is sy A / .8, less what the elastic volume takes."""
    model = ring(0.0, 10.0, 20.0, nx=3, ny=4, material=IDEAL, element="Q8R")
    model.fix("bottom", x=None)
    step = ct.Static()
    step.fix("top", x=None, y=-4.0)
    force = solve(model, step).frames[-1].RF[model.mesh.node_sets["top"], 1].sum()
    assert force == pytest.approx(-240.0 * np.pi * 100.0 / 0.8, rel=2e-3)


# Rubber of constant volume, shear modulus 1.
RUBBER = ct.NeoHooke(C10=0.5, D1=2e-5)


def test_neo_hooke_bar() -> None:
    model = ring(0.0, 1.0, 2.0, nx=2, ny=2, material=RUBBER, element="Q8R")
    model.fix("bottom", x=None)
    step = ct.Static()
    step.fix("top", x=None, y=2.0)
    force = solve(model, step).frames[-1].RF[model.mesh.node_sets["top"], 1].sum()
    assert force == pytest.approx(np.pi * (2.0 - 1.0 / 4.0), rel=1e-4)


def test_neo_hooke_sheet_is_stretched_all_around() -> None:
    """Equal stretches 1.5 in the plane: force per reference area 1.5 - 1.5^-5."""
    model = ring(0.0, 10.0, 1.0, nx=6, ny=1, material=RUBBER, element="Q8R")
    model.fix("bottom", x=None)
    step = ct.Static()
    step.fix("right", x=5.0, y=None)
    force = solve(model, step).frames[-1].RF[model.mesh.node_sets["right"], 0].sum()
    assert force == pytest.approx(20.0 * np.pi * (1.5 - 1.5**-5), rel=1e-3)


@pytest.mark.parametrize(
    ("stretch", "exact"), [(1.2, 0.2333698), (1.5, 0.4282284), (2.0, 0.5740536), (3.0, 0.6604173)]
)
def test_neo_hooke_tube(stretch: float, exact: float) -> None:
    """A = 1, B = 2, plane strain: pressure over the shear modulus."""
    model = ring(1.0, 2.0, 0.2, nx=10, ny=1, material=RUBBER, element="Q8R")
    model.fix("bottom", x=None)
    model.fix("top", x=None)
    inside = model.mesh.node_sets["left"]
    step = ct.Static()
    step.fix(inside, x=stretch - 1.0, y=None)
    force = solve(model, step).frames[-1].RF[inside, 0].sum()
    pressure = force / (2.0 * np.pi * stretch * 0.2)
    assert pressure == pytest.approx(exact, abs=1e-3)


# Contact.
def test_three_rings_shrunk_on_one_another() -> None:
    """Two interferences at once beside the linear system of Lame's flexibilities."""
    r, gaps, h = [30.0, 40.0, 50.0, 65.0], [0.01, 0.02], 4.0
    meshes = []
    for k in range(3):
        inner = r[k]
        outer = r[k + 1] + (gaps[k] if k < 2 else 0.0)
        part = ct.mesh.rectangle(outer - inner, h, 6, 2 + k, cell="quad8")
        part.points[:, 0] += inner
        meshes.append(part)
    model = ct.Model(ct.mesh.assembly(a=meshes[0], b=meshes[1], c=meshes[2]))
    model.section("all", element="Q8", material=ct.Elastic(E, NU), plane="axisymmetric")
    for part in "abc":
        model.fix(f"{part}.bottom", x=None)
    model.contact("a.right", "b.left")
    model.contact("b.right", "c.left")
    frame = solve(model, ct.Static()).frames[-1]

    # Unknown pressures at 40 and 50; displacements by Lame in plane stress.
    def out(a: float, b: float, at: float, p_in: float, p_out: float) -> float:
        k = b**2 - a**2
        mean = (p_in * a**2 - p_out * b**2) / k
        return at / E * ((1.0 - NU) * mean + (1.0 + NU) * (p_in - p_out) * (a * b / at) ** 2 / k)

    m = np.zeros((2, 2))
    for j, (p, q) in enumerate(((1.0, 0.0), (0.0, 1.0))):
        m[0, j] = out(40.0, 50.0, 40.0, p, q) - out(30.0, 40.0, 40.0, 0.0, p)
        m[1, j] = out(50.0, 65.0, 50.0, q, 0.0) - out(40.0, 50.0, 50.0, p, q)
    pressure = np.linalg.solve(m, gaps)
    rim = out(50.0, 65.0, 65.0, float(pressure[1]), 0.0)
    assert frame.U[model.mesh.node_sets["c.right"], 0].mean() == pytest.approx(rim, rel=2e-3)


def test_two_equal_spheres() -> None:
    """Hertz with two elastic bodies: 1 / R adds up to 2 / 8, the compliances to 2 / E'."""
    low, high = quarter(8.0, 24, "Q4I", upper=True), quarter(8.0, 20, "Q4I")
    high.points[:, 1] += low.points[:, 1].max() - high.points[:, 1].min()
    young, nu, force = 200.0, 0.3, 10.0
    mesh = ct.mesh.assembly(high=high, low=low)
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(young, nu), plane="axisymmetric")
    model.fix("low.bottom", x=None)
    model.contact("high.bottom", "low.top")
    model.traction("high.top", y=-force / (np.pi * 8.0**2))
    results = solve(model)
    pressed = young / (1.0 - nu**2) / 2.0
    radius = (0.75 * force * 4.0 / pressed) ** (1.0 / 3.0)
    peak = 1.5 * force / (np.pi * radius**2)
    assert results.nodal("CPRESS").max() == pytest.approx(peak, rel=0.03)


def half_space() -> ct.Mesh:
    """A block of 400 with cells of .5 below the middle of its top."""
    places = np.concatenate([np.linspace(0.0, 12.0, 25), np.geomspace(12.6, 400.0, 24)])
    mesh = ct.mesh.rectangle(1.0, 1.0, 48, 48)
    share = np.linspace(0.0, 1.0, 49)
    mesh.points[:, 0] = np.interp(mesh.points[:, 0], share, places)
    mesh.points[:, 1] = -np.interp(1.0 - mesh.points[:, 1], share, places)
    return mesh


def test_cone_pressed_into_a_half_space() -> None:
    """Sneddon 1965: F = 2 E' d^2 / (pi tan b), b the angle between cone and surface.

    He leaves the radial displacement of the surface out, which vanishes at constant volume.
    """
    mesh = half_space()
    tip = ct.mesh.add_node(mesh, 0.0, 50.0, "cone")
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(1000.0, 0.495), plane="axisymmetric")
    model.fix("bottom")
    slope = np.tan(np.radians(5.0))
    cone = ct.RigidCurve.line((200.0, 200.0 * slope), (0.0, 0.0), reference=tip)
    model.contact("top", cone)
    step = ct.Static(nlgeom=False)
    step.fix("cone", x=None, y=-1.0)
    force = -solve(model, step).frames[-1].RF[tip, 1]
    assert force == pytest.approx(2.0 * 1000.0 / (1.0 - 0.495**2) / (np.pi * slope), rel=0.03)


def test_flat_punch_on_a_half_space() -> None:
    """Boussinesq: F = 2 a E' d, the punch as equal displacements of the nodes below it."""
    model = ct.Model(half_space())
    model.section("all", element="Q4I", material=ct.Elastic(1000.0, 0.3), plane="axisymmetric")
    model.fix("bottom")
    points = model.mesh.points
    below = np.flatnonzero((points[:, 1] == 0.0) & (points[:, 0] <= 10.0 + 1e-9))
    model.fix(below, x=None, y=-1.0)
    force = -solve(model).frames[-1].RF[below, 1].sum()
    assert force == pytest.approx(2.0 * 10.0 * 1000.0 / 0.91, rel=0.05)
