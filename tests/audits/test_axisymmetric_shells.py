"""Audit of plates, shells and vibrations of solids of revolution beside closed forms: 30 checks.

Written from the documents, without a look at the core. Plates and shells are solids with one or two
quadratic elements across their thickness; where a closed form leaves shear out, they are thin.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from scipy.optimize import brentq
from scipy.special import j0, j1

import corota as ct

E, NU, RHO, ALPHA = 200e3, 0.3, 8e-9, 1e-5
STEEL = ct.Elastic(E, NU, rho=RHO, expansion=ALPHA)
LINEAR = ct.Static(nlgeom=False)
R, T = 100.0, 2.0
D = E * T**3 / (12.0 * (1.0 - NU**2))


def body(mesh: ct.Mesh, material: Any = STEEL, element: str = "Q8R") -> ct.Model:
    model = ct.Model(mesh)
    model.section("all", element=element, material=material, plane="axisymmetric")
    return model


def plate(inner: float = 0.0, outer: float = R, thickness: float = T, n: int = 40) -> ct.Model:
    mesh = ct.mesh.rectangle(outer - inner, thickness, n, 2, cell="quad8")
    mesh.points[:, 0] += inner
    mesh.points[:, 1] -= 0.5 * thickness
    return body(mesh)


def shell(
    middle: Callable[[np.ndarray], np.ndarray], n: int, thickness: float, element: str = "Q8R"
) -> ct.Model:
    """Solid about a curve `middle(s)`, 0 <= s <= 1, with its top on the left; 2 elements across."""
    mesh = ct.mesh.rectangle(1.0, thickness, n, 2, cell="quad8")
    s, across = mesh.points[:, 0], mesh.points[:, 1] - 0.5 * thickness
    step = 1e-6
    along = (middle(s + step) - middle(s - step)) / (2.0 * step)
    along /= np.hypot(*along)
    mesh.points[:] = (middle(s) + across * np.stack([-along[1], along[0]])).T
    return body(mesh, element=element)


def solve(model: ct.Model, step: Any = LINEAR) -> ct.Results:
    return ct.solve(model, step, threads=1)


def node(model: ct.Model, x: float, y: float) -> int:
    return int(np.argmin(np.hypot(*(model.mesh.points - [x, y]).T)))


def middle_of(model: ct.Model, side: str) -> list[int]:
    nodes = model.mesh.node_sets[side]
    return [int(nodes[np.argmin(np.abs(model.mesh.points[nodes, 1]))])]


def sag(results: ct.Results, x: float = 0.0) -> float:
    return -float(results.frames[-1].U[node(results.model, x, 0.0), 1])


# Plates: Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, ch. 3 and 13.
def test_clamped_plate_under_pressure() -> None:
    model = plate()
    model.fix("right")
    model.pressure("top", 0.1)
    assert sag(solve(model)) == pytest.approx(0.1 * R**4 / (64.0 * D), rel=5e-3)


def test_supported_plate_under_pressure() -> None:
    model = plate()
    model.fix(middle_of(model, "right"), x=None)
    model.pressure("top", 0.1)
    exact = (5.0 + NU) / (1.0 + NU) * 0.1 * R**4 / (64.0 * D)
    assert sag(solve(model)) == pytest.approx(exact, rel=5e-3)


def test_clamped_plate_with_a_force_on_the_axis() -> None:
    """F R^2 / 16 pi D; half way out F / (8 pi D) (r^2 ln(r / R) + (R^2 - r^2) / 2)."""
    model = plate()
    model.fix("right")
    model.force([node(model, 0.0, 0.0)], y=-1000.0)
    r = 0.5 * R
    exact = 1000.0 / (8.0 * np.pi * D) * (r**2 * np.log(r / R) + 0.5 * (R**2 - r**2))
    assert sag(solve(model), r) == pytest.approx(exact, rel=5e-3)


def test_plate_with_a_moment_around_its_edge() -> None:
    """M R^2 / 2 D (1 + nu), M by two rings of forces."""
    model = plate()
    rim = middle_of(model, "right")
    model.fix(rim, x=None)
    moment = 10.0
    force = moment * 2.0 * np.pi * R / T
    model.force([node(model, R, 0.5 * T)], x=-force)
    model.force([node(model, R, -0.5 * T)], x=force)
    exact = moment * R**2 / (2.0 * D * (1.0 + NU))
    assert sag(solve(model)) == pytest.approx(exact, rel=5e-3)


def test_plate_heated_through_its_thickness() -> None:
    """Free: a sphere of curvature alpha dT / t without stress."""
    model = plate()
    model.fix([node(model, 0.0, 0.0)], x=None)
    model.temperature(-50.0 * model.mesh.points[:, 1] / T)
    results = solve(model)
    assert -sag(results, R) == pytest.approx(ALPHA * 50.0 / T * R**2 / 2.0, rel=1e-6)
    assert np.abs(results.nodal("S11")).max() < 1e-5


def test_clamped_plate_heated_through_its_thickness() -> None:
    """Moments (1 + nu) D alpha dT / t everywhere, no deflection."""
    model = plate()
    model.fix("right")
    model.temperature(50.0 * model.mesh.points[:, 1] / T)
    results = solve(model)
    stress = results.nodal("S11")[node(model, 20.0, 0.5 * T)]
    # The clamp holds the thickness, too, which bends the plate by its share t / R.
    assert stress == pytest.approx(-E * ALPHA * 25.0 / (1.0 - NU), rel=5e-3)


def annular(c: np.ndarray, r: float) -> tuple[float, float, float]:
    """Deflection, slope and radial moment of c0 + c1 r^2 + c2 ln r + c3 r^2 ln r."""
    w = c @ np.array([1.0, r**2, np.log(r), r**2 * np.log(r)])
    slope = c @ np.array([0.0, 2.0 * r, 1.0 / r, r * (2.0 * np.log(r) + 1.0)])
    second = c @ np.array([0.0, 2.0, -1.0 / r**2, 2.0 * np.log(r) + 3.0])
    return w, slope, D * (second + NU * slope / r)


def test_annular_plate_clamped_inside() -> None:
    """Ring force on its free rim, from the four constants of the plate equation."""
    a, b, force = 40.0, 100.0, 1000.0
    model = plate(a, b)
    model.fix("left")
    model.force(middle_of(model, "right"), y=-force)
    unit = np.eye(4)
    rows = [[annular(u, a)[0] for u in unit], [annular(u, a)[1] for u in unit],
            [annular(u, b)[2] for u in unit], [0.0, 0.0, 0.0, 1.0]]  # fmt: skip
    # The shear D d(lap w)/dr = 4 D c3 / r carries the force over 2 pi r.
    c = np.linalg.solve(np.array(rows), [0.0, 0.0, 0.0, -force / (8.0 * np.pi * D)])
    assert sag(solve(model), b) == pytest.approx(abs(annular(c, b)[0]), rel=1e-2)


def test_annular_plate_supported_outside() -> None:
    """Ring force on its free inner rim."""
    a, b, force = 40.0, 100.0, 1000.0
    model = plate(a, b)
    model.fix(middle_of(model, "right"), x=None)
    model.force(middle_of(model, "left"), y=-force)
    unit = np.eye(4)
    rows = [[annular(u, b)[0] for u in unit], [annular(u, a)[2] for u in unit],
            [annular(u, b)[2] for u in unit], [0.0, 0.0, 0.0, 1.0]]  # fmt: skip
    c = np.linalg.solve(np.array(rows), [0.0, 0.0, 0.0, force / (8.0 * np.pi * D)])
    assert sag(solve(model), a) == pytest.approx(abs(annular(c, a)[0]), rel=1e-2)


@pytest.mark.parametrize("pressure", [0.3, 3.0])
def test_large_deflection_of_a_clamped_plate(pressure: float) -> None:
    """Von Karman's equations for slope and radial force, integrated by scipy."""

    def field(r: np.ndarray, y: np.ndarray) -> np.ndarray:
        # y: w, slope f, f', radial displacement u, u'.
        _, f, df, u, du = y
        c = E * T / (1.0 - NU**2)
        force = c * (du + 0.5 * f**2 + NU * u / r)
        ddf = (force * f + 0.5 * pressure * r) / D - df / r + f / r**2
        ddu = -du / r + u / r**2 - (1.0 - NU) / (2.0 * r) * f**2 - f * df
        return np.stack([f, df, ddf, du, ddu])

    small = 1e-3 * R
    r = np.linspace(small, R, 200)
    guess = np.zeros((5, 200))
    guess[0] = T * (1.0 - (r / R) ** 2) ** 2
    # Slope of a deflection that is positive along the load: the sign of p in the equation.
    ends = lambda a, b: np.array([a[1] - a[2] * small, a[3] - a[4] * small, b[0], b[1], b[3]])  # noqa: E731
    found = solve_bvp(field, ends, r, guess, tol=1e-6, max_nodes=20000)
    assert found.success
    model = plate()
    model.fix("right")
    model.pressure("top", pressure)
    step = ct.Static()
    assert sag(solve(model, step)) == pytest.approx(abs(found.y[0, 0]), rel=1e-2)


# Membranes of revolution.
def test_thin_sphere_under_pressure() -> None:
    """p R^2 (1 - nu) / 2 E t, pressure on the mean radius."""
    t = 0.5
    arc = lambda s: R * np.stack([np.cos(0.5 * np.pi * s), np.sin(0.5 * np.pi * s)])  # noqa: E731
    model = shell(arc, 32, t)
    model.fix("left", x=None)
    model.pressure("top", 1.0)
    u = solve(model).frames[-1].U[node(model, 0.0, R), 1]
    assert abs(u) == pytest.approx(R**2 * (1.0 - NU) / (2.0 * E * t), rel=1e-2)


def test_weight_of_a_dome() -> None:
    """Meridional force w R / (1 + cos phi): half of w R at the crown, w R at the equator."""
    t = 1.0
    arc = lambda s: R * np.stack([np.cos(0.5 * np.pi * s), np.sin(0.5 * np.pi * s)])  # noqa: E731
    model = shell(arc, 40, t)
    model.fix("left", x=None)
    model.gravity(y=-9810.0)
    results = solve(model)
    weight = RHO * 9810.0
    crown = results.nodal("S11")[node(model, 0.0, R)]
    assert crown == pytest.approx(-0.5 * weight * R, rel=2e-2)
    total = results.frames[-1].RF[:, 1].sum()
    assert total == pytest.approx(2.0 * np.pi * R**2 * t * weight, rel=1e-3)


def test_cone_under_pressure() -> None:
    """Half angle 30, open: hoop stress p r / t cos a, meridional p (r^2 - b^2) / 2 r t cos a.

    The small end stands on rollers, the large one, of radius b, is free.
    """
    t, a, b = 0.25, np.radians(30.0), 100.0
    line = lambda s: np.stack([50.0 + b * np.sin(a) * s, b * np.cos(a) * s])  # noqa: E731
    model = shell(line, 120, t)
    model.fix("left", x=None)
    model.pressure("top", 1.0)
    r = 75.0
    u = solve(model).frames[-1].U[node(model, r, 50.0 * np.cos(a))]
    hoop = r / (t * np.cos(a))
    along = (r**2 - b**2) / (2.0 * r * t * np.cos(a))
    assert u[0] == pytest.approx(r / E * (hoop - NU * along), rel=2e-2)


def test_ring_load_on_a_long_cylinder() -> None:
    """Q beta R^2 / 2 E t, beta^4 = 3 (1 - nu^2) / R^2 t^2, the middle plane a symmetry."""
    t, line = 1.0, 10.0
    mesh = ct.mesh.rectangle(t, 100.0, 2, 100, cell="quad8")
    mesh.points[:, 0] += R - 0.5 * t
    model = body(mesh)
    model.fix("bottom", x=None)
    model.force([node(model, R, 0.0)], x=0.5 * line * 2.0 * np.pi * R)
    beta = (3.0 * (1.0 - NU**2)) ** 0.25 / np.sqrt(R * t)
    u = solve(model).frames[-1].U[node(model, R, 0.0), 0]
    assert u == pytest.approx(line * beta * R**2 / (2.0 * E * t), rel=1e-2)


def test_clamped_end_of_a_pressed_cylinder() -> None:
    """1 - exp(-b x)(cos b x + sin b x) of the free displacement."""
    t = 1.0
    mesh = ct.mesh.rectangle(t, 100.0, 2, 100, cell="quad8")
    mesh.points[:, 0] += R - 0.5 * t
    model = body(mesh)
    model.fix("bottom")
    model.pressure("left", 1.0)
    results = solve(model)
    beta = (3.0 * (1.0 - NU**2)) ** 0.25 / np.sqrt(R * t)
    far = results.frames[-1].U[node(model, R, 80.0), 0]
    for x in (5.0, 10.0, 15.0):
        share = 1.0 - np.exp(-beta * x) * (np.cos(beta * x) + np.sin(beta * x))
        u = results.frames[-1].U[node(model, R, x), 0]
        assert u == pytest.approx(far * share, rel=2e-2)


def test_ring_that_is_rolled() -> None:
    """Couple m along the circle: angle m R^2 / E I (Timoshenko, Strength of Materials II)."""
    h, b = 4.0, 3.0
    mesh = ct.mesh.rectangle(b, h, 6, 8, cell="quad8")
    mesh.points[:] += [R - 0.5 * b, -0.5 * h]
    model = body(mesh)
    model.fix([node(model, R, 0.0)], x=None)
    force = 2.0 * np.pi * R * 10.0 / h
    model.force([node(model, R, 0.5 * h)], x=force)
    model.force([node(model, R, -0.5 * h)], x=-force)
    u = solve(model).frames[-1].U
    angle = (u[node(model, R, 0.25 * h), 0] - u[node(model, R, -0.25 * h), 0]) / (0.5 * h)
    assert angle == pytest.approx(10.0 * R**2 / (E * b * h**3 / 12.0), rel=2e-2)


# Buckling: Timoshenko and Gere, Theory of Elastic Stability, art. 9.6 and 11.13.
@pytest.mark.parametrize(("clamped", "factor"), [(True, 14.682), (False, 4.198)])
def test_plate_pressed_around_its_rim(clamped: bool, factor: float) -> None:
    model = plate()
    if clamped:
        # The rim moves inward without turning.
        rim = model.mesh.node_sets["right"]
        for other in rim[1:]:
            model.equation((int(other), "x", 1.0), (int(rim[0]), "x", -1.0))
        model.fix("right", x=None)
        model.force([int(rim[0])], x=-2.0 * np.pi * R)
    else:
        model.fix(middle_of(model, "right"), x=None)
        model.traction("right", x=-1.0 / T)
    found = solve(model, ct.Buckle(modes=1)).modes[0].factors[0]
    assert found == pytest.approx(factor * D / R**2, rel=1e-2)


def test_plate_that_is_held_and_heated_buckles() -> None:
    """E alpha dT t / (1 - nu) = 14.682 D / R^2."""
    model = plate()
    model.fix("right")
    model.temperature(1.0)
    found = solve(model, ct.Buckle(modes=1)).modes[0].factors[0]
    assert found == pytest.approx(14.682 * D / R**2 * (1.0 - NU) / (E * ALPHA * T), rel=1e-2)


def test_sphere_under_outer_pressure_buckles() -> None:
    """2 E t^2 / (R^2 sqrt(3 (1 - nu^2))), by axisymmetric modes too (Zoelly 1915)."""
    t = 1.0
    arc = lambda s: R * np.stack([np.cos(0.5 * np.pi * s), np.sin(0.5 * np.pi * s)])  # noqa: E731
    model = shell(arc, 100, t)
    model.fix("left", x=None)
    model.pressure("bottom", 1.0)
    found = abs(solve(model, ct.Buckle(modes=1)).modes[0].factors[0])
    exact = 2.0 * E * t**2 / (R**2 * np.sqrt(3.0 * (1.0 - NU**2)))
    assert found == pytest.approx(exact, rel=2e-2)


# Frequencies: Leissa, Vibration of Plates, ch. 2; Love, Mathematical Theory of Elasticity.
def frequencies(model: ct.Model, modes: int = 3) -> np.ndarray:
    return 2.0 * np.pi * np.asarray(solve(model, ct.Frequency(modes=modes)).modes[0].factors)


@pytest.mark.parametrize(
    ("support", "squares"),
    [("free", (9.003, 38.443)), ("clamped", (10.2158, 39.771)), ("supported", (4.9351, 29.720))],
)
def test_frequencies_of_circular_plates(support: str, squares: tuple[float, float]) -> None:
    model = plate()
    if support == "clamped":
        model.fix("right")
    elif support == "supported":
        model.fix(middle_of(model, "right"), x=None)
    found = frequencies(model)
    if support == "free":
        assert abs(found[0]) < 1e-3 * found[1]
        found = found[1:]
    exact = np.array(squares) / R**2 * np.sqrt(D / (RHO * T))
    np.testing.assert_allclose(found[:2], exact, rtol=1e-2)


def test_thin_sphere_breathes() -> None:
    """sqrt(2 E / (1 - nu) rho) / R."""
    arc = lambda s: R * np.stack([np.cos(0.5 * np.pi * s), np.sin(0.5 * np.pi * s)])  # noqa: E731
    model = shell(arc, 24, 0.5)
    model.fix("left", x=None)
    exact = np.sqrt(2.0 * E / ((1.0 - NU) * RHO)) / R
    found = frequencies(model, 30)
    assert np.abs(found / exact - 1.0).min() < 3e-3


def test_solid_sphere_breathes() -> None:
    """tan x / x = 1 / (1 - x^2 / (4 (c_s / c_p)^2)), omega = x c_p / a (Love, art. 196)."""
    a = 50.0
    mesh = ct.mesh.annulus(0.02, a, 20, 12, angle=90.0, cell="quad8")
    model = body(mesh)
    model.fix("start", x=None)
    ratio = (1.0 - 2.0 * NU) / (2.0 * (1.0 - NU))
    x = brentq(lambda z: np.tan(z) * (1.0 - z**2 / (4.0 * ratio)) - z, 2.0, 3.0)
    speed = np.sqrt(E * (1.0 - NU) / ((1.0 + NU) * (1.0 - 2.0 * NU) * RHO))
    found = frequencies(model, 8)
    assert np.abs(found / (x * speed / a) - 1.0).min() < 2e-3


def test_long_solid_cylinder_breathes() -> None:
    """x J0(x) / J1(x) = (1 - 2 nu) / (1 - nu) under plane strain."""
    a = 50.0
    mesh = ct.mesh.rectangle(a, 5.0, 20, 1, cell="quad8")
    model = body(mesh)
    for side in ("bottom", "top"):
        model.fix(side, x=None)
    x = brentq(lambda z: z * j0(z) * (1.0 - NU) - (1.0 - 2.0 * NU) * j1(z), 1.5, 2.4)
    speed = np.sqrt(E * (1.0 - NU) / ((1.0 + NU) * (1.0 - 2.0 * NU) * RHO))
    assert frequencies(model, 1)[0] == pytest.approx(x * speed / a, rel=1e-3)


def test_rod_vibrates_along_its_axis() -> None:
    """c / 4 L with Rayleigh's correction 1 - nu^2 (pi a / 2 L)^2 / 4."""
    a, length = 5.0, 100.0
    model = body(ct.mesh.rectangle(a, length, 2, 40, cell="quad8"))
    model.fix("bottom", x=None)
    wave = np.pi / (2.0 * length)
    exact = wave * np.sqrt(E / RHO) * (1.0 - 0.25 * (NU * wave * a) ** 2)
    assert frequencies(model, 1)[0] == pytest.approx(exact, rel=1e-3)


def test_ring_rolls_back_and_forth() -> None:
    """omega^2 = E I_x / (rho I_p R^2)."""
    h, b = 4.0, 3.0
    mesh = ct.mesh.rectangle(b, h, 3, 4, cell="quad8")
    mesh.points[:] += [R - 0.5 * b, -0.5 * h]
    model = body(mesh)
    model.fix([node(model, R, 0.0)], x=None)
    exact = np.sqrt(E * h**2 / (RHO * (h**2 + b**2))) / R
    assert frequencies(model, 1)[0] == pytest.approx(exact, rel=1e-2)


# Motion.
def test_a_ring_falls() -> None:
    model = plate(50.0, 60.0, n=2)
    model.gravity(y=-9810.0)
    frame = solve(model, ct.Dynamic(period=0.1, increments=10)).frames[-1]
    np.testing.assert_allclose(frame.U[:, 1], -0.5 * 9810.0 * 0.1**2, rtol=1e-6)


def test_kinetic_energy_of_a_moving_ring() -> None:
    model = plate(50.0, 60.0, n=2)
    model.velocity("", y=1000.0)
    frame = solve(model, ct.Dynamic(period=0.01, increments=4)).frames[-1]
    mass = RHO * np.pi * (60.0**2 - 50.0**2) * T
    assert frame.scalars["ALLKE"] == pytest.approx(0.5 * mass * 1000.0**2, rel=1e-9)


def test_sudden_pressure_doubles_the_displacement_of_a_ring() -> None:
    model = body(ct.mesh.rectangle(1.0, 1.0, 1, 1, cell="quad8"))
    model.mesh.points[:] += [R - 0.5, -0.5]
    half = np.pi * R / np.sqrt(E / RHO)
    model.pressure("left", 1.0 * R / (R - 0.5))
    step = ct.Dynamic(period=half, increments=60)
    frames = solve(model, step).frames
    peak = max(float(f.U[:, 0].mean()) for f in frames)
    assert peak == pytest.approx(2.0 * R**2 / E, rel=2e-2)


def test_rod_against_a_rigid_wall() -> None:
    """Force rho c A v while the wave runs, c = sqrt(E / rho) at nu = 0."""
    a, length, speed = 2.0, 50.0, 1000.0
    mesh = ct.mesh.rectangle(a, length, 2, 50)
    wall = ct.RigidCurve.line((-10.0, 0.0), (10.0, 0.0))
    model = body(mesh, ct.Elastic(E, 0.0, rho=RHO), "Q4")
    model.contact("bottom", wall, name="wall")
    model.velocity("", y=-speed)
    c = np.sqrt(E / RHO)
    step = ct.Dynamic(period=length / c, increments=50)
    results = solve(model, step)
    force = np.abs(results.history("wall: force y"))[5:-5]
    assert force.mean() == pytest.approx(RHO * c * np.pi * a**2 * speed, rel=3e-2)


def test_steady_vibration_of_a_ring() -> None:
    """Amplitude p R^2 / E t (1 - (w / w0)^2) at .6 of its frequency."""
    model = body(ct.mesh.rectangle(1.0, 1.0, 1, 1, cell="quad8"))
    model.mesh.points[:] += [R - 0.5, -0.5]
    model.fix([node(model, R, 0.0)], x=None)
    natural = np.sqrt(E / RHO) / R / (2.0 * np.pi)
    step = ct.SteadyState(lowest=0.6 * natural, highest=0.8 * natural, points=2, direct=True)
    step.pressure("left", R / (R - 0.5))
    for frame, share in zip(solve(model, step).frames[-2:], (0.6, 0.8), strict=True):
        assert frame.scalars["frequency"] == pytest.approx(share * natural)
        exact = R**2 / E / (1.0 - share**2)
        assert frame.U[:, 0].mean() == pytest.approx(exact, rel=1e-2)


def test_two_layers_of_a_sphere_expand_unlike() -> None:
    """Bonded layers 50 to 70 and 70 to 100, heated by 80: the pressure between them by Lame."""
    a, c, b, rise = 50.0, 70.0, 100.0, 80.0
    layers = [(ct.Elastic(70e3, 0.33, expansion=2.3e-5), a, c), (STEEL, c, b)]

    def moved(r: float, layer: int, inside: float, outside: float) -> float:
        """Radial displacement under unit pressures, without heat (Timoshenko and Goodier)."""
        law, low, high = layers[layer]
        size = high**3 - low**3
        spread = (1.0 - 2.0 * law.nu) * (inside * low**3 - outside * high**3) * r
        shear = 0.5 * (1.0 + law.nu) * (inside - outside) * (low * high) ** 3 / r**2
        return (spread + shear) / (law.E * size)

    alphas = [law.expansion for law, _, _ in layers]
    apart = (alphas[0] - alphas[1]) * rise * c
    between = apart / (moved(c, 1, 1.0, 0.0) - moved(c, 0, 0.0, 1.0))
    model = ct.Model(ct.mesh.annulus(a, b, 10, 16, angle=90.0, cell="quad8"))
    far = np.hypot(*model.mesh.points[model.mesh.cells[0].nodes].mean(axis=1).T)
    for (law, _, _), inside in zip(layers, (far < c, far >= c), strict=True):
        model.section(np.flatnonzero(inside), element="Q8R", material=law, plane="axisymmetric")
    model.fix("start", x=None)
    step = ct.Static(nlgeom=False)
    step.temperature(rise)
    u = solve(model, step).frames[-1].U
    for r, layer, pressures in ((a, 0, (0.0, between)), (b, 1, (between, 0.0))):
        exact = alphas[layer] * rise * r + moved(r, layer, *pressures)
        assert u[node(model, r, 0.0), 0] == pytest.approx(exact, rel=1e-4)
        assert u[node(model, 0.0, r), 1] == pytest.approx(exact, rel=1e-3)
