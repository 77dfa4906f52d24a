"""Analytic elastoplastic cases, with the rate at which the meshes approach them."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import corota as ct
from corota.verification.plastic_models import CELL, DRILLING, find, notched


def ring(element: str, n: int, plane: str, nu: float, sy: float, p: float, **options: Any):
    """Quarter of a ring 100..200 under inner pressure, small displacements."""
    mesh = ct.mesh.annulus(100.0, 200.0, n, 2 * n, 90.0, CELL[element])
    model = ct.Model(mesh)
    law = ct.Mises(E=210000.0, nu=nu, yield_stress=sy)
    model.section("all", element=element, material=law, plane=plane, **options)
    turn = 0.0 if element in DRILLING else None
    model.fix("start", x=None, y=0.0, rotation=turn)
    model.fix("end", x=0.0, y=None, rotation=turn)
    model.pressure("inner", p)
    results = ct.solve(model, ct.Static(nlgeom=False, increments=8), threads=1)
    outer = mesh.nodes_of("outer")
    return results, float(np.linalg.norm(results.frames[-1].U[outer], axis=1).mean())


def hill(c: float, nu: float) -> tuple[float, float]:
    """Pressure and outer displacement of a thick cylinder that is plastic to radius c (Hill)."""
    a, b, strength = 100.0, 200.0, 2 * 240.0 / 3**0.5
    p = strength * (np.log(c / a) + 0.5 * (1 - (c / b) ** 2))
    return p, strength * c**2 * (1 - nu**2) / (210000.0 * b)


@pytest.mark.parametrize(
    ("element", "options"),
    [
        ("Q4I", {}),
        ("Q8R", {}),
        ("Q4D", {"mean_dilatation": True}),
        ("Q4", {"mean_dilatation": True}),
    ],
)
def test_thick_cylinder(element: str, options: dict[str, Any]) -> None:
    """Hill's solution is exact for an incompressible material."""
    for c in (120.0, 160.0):
        p, u = hill(c, 0.4999)
        errors = []
        for n in (6, 12):
            _, computed = ring(element, n, "strain", 0.4999, 240.0, p, **options)
            errors.append(abs(computed / u - 1.0))
        assert errors[1] < 0.01, (c, errors)
        assert errors[1] < 0.6 * errors[0] or errors[1] < 2e-4, (c, errors)


@pytest.mark.parametrize(("p", "u"), [(160.0, 0.111633), (180.0, 0.153985), (190.0, 0.20537)])
def test_thick_cylinder_of_steel(p: float, u: float) -> None:
    """Converged values for nu = 0.3, where Hill's are not exact."""
    assert ring("Q8R", 12, "strain", 0.3, 240.0, p)[1] == pytest.approx(u, rel=0.003)


def nadai(c: float, sy: float, E: float) -> tuple[float, float, Any]:
    """Plane-stress ring that is plastic to radius c: inner pressure, outer displacement, and
    the radial stress as a function of the radius.

    In the plastic part ``s_r = 2/sqrt3 sy cos(w + pi/6)``, ``s_t = 2/sqrt3 sy cos(w - pi/6)``
    fulfil the yield condition, and equilibrium gives ``r^2 sin(w) exp(sqrt3 w) = const``
    (A. Nadai, Theory of Flow and Fracture of Solids, 1950); outside Lame's solution holds.
    """
    a, b = 100.0, 200.0
    k = (b / c) ** 2
    big = sy / np.sqrt(1 + 3 * k**2)
    w_c = np.arctan(np.sqrt(3) * k)

    def constant(r: float, w: float) -> float:
        return float(r**2 * np.sin(w) * np.exp(np.sqrt(3) * w))

    def radial(r: float) -> float:
        if r >= c:
            return float(big * (1 - (b / r) ** 2))
        # The branch on which the circumferential stress falls inwards.
        w = brentq(lambda w: constant(r, w) - constant(c, w_c), w_c, 5 * np.pi / 6)
        return float(2 / np.sqrt(3) * sy * np.cos(w + np.pi / 6))

    return -radial(a), 2 * big * b / E, radial


@pytest.mark.parametrize("element", ["Q4I", "Q8", "Q8R", "Q4D", "OPT", "T6"])
def test_ring_in_plane_stress(element: str) -> None:
    """Nadai's solution: displacement within 1 %, radial stress, and the rate."""
    sy = 240.0
    p, u, radial = nadai(140.0, sy, 210000.0)
    errors = []
    for n in (6, 12):
        results, computed = ring(element, n, "stress", 0.3, sy, p)
        errors.append(abs(computed / u - 1.0))
    assert errors[1] < 0.01, errors
    assert errors[1] < 0.6 * errors[0] or errors[1] < 5e-4, errors
    fields = results.frames[-1].fields[0]
    x, s = fields.points.reshape(-1, 2), fields.values["S"].reshape(-1, 4)
    r = np.linalg.norm(x, axis=1)
    cos, sin = (x / r[:, None]).T
    mine = cos**2 * s[:, 0] + sin**2 * s[:, 1] + 2 * cos * sin * s[:, 3]
    exact = np.array([radial(v) for v in r])
    size = fields.volume.ravel()
    assert np.sqrt(size @ (mine - exact) ** 2 / size.sum()) < 0.04 * sy


def bend(curvature: list[float], element: str = "Q8", layers: int = 10) -> np.ndarray:
    """Bending moment over that at first yield, along a history of curvatures over the first."""
    height, length = 1.0, 0.5
    mesh = ct.mesh.rectangle(length, height, 1, layers, CELL[element], origin=(0.0, -0.5))
    model = ct.Model(mesh)
    E, sy = 200000.0, 200.0
    model.section("all", element=element, material=ct.Mises(E=E, nu=0.0, yield_stress=sy))
    turn = element in DRILLING
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    first = 2 * sy / E / height
    right = mesh.nodes_of("right")
    y = mesh.points[right, 1]
    steps = []
    for value in curvature:
        held = [
            ct.model.Fixed(np.array([node]), 0, -value * first * length * height_y)
            for node, height_y in zip(right, y, strict=True)
        ]
        if turn:
            held.append(ct.model.Fixed(right, 2, value * first * length))
        steps.append(ct.Static(nlgeom=False, increments=4, supports=held))
    results = ct.solve(model, steps, threads=1)
    last = [f for f in results.frames if f.factor == 1.0]
    moment = [-(f.RF[right, 0] @ y) for f in last]
    return np.array(moment) / (sy * height**2 / 6)


def test_bending_beyond_yield() -> None:
    """``M / M_y = 1.5 - 0.5 (k_y / k)^2``, and elastic springback."""
    ratio = np.array([1.5, 2.0, 3.0, 5.0, 10.0])
    moment = bend([*ratio, 10.0 - (1.5 - 0.005)])
    assert moment[:-1] == pytest.approx(1.5 - 0.5 / ratio**2, rel=0.005)
    # Unloading by the elastic curvature of that moment leaves none.
    assert abs(moment[-1]) < 0.01


def test_cantilever_beyond_yield() -> None:
    """Deflection at 1.2 and 1.45 times the elastic limit load (Prager & Hodge)."""
    length, E, sy = 40.0, 200000.0, 200.0
    mesh = ct.mesh.rectangle(length, 1.0, 80, 6, "quad8")
    limit = sy / (6 * length)
    elastic = limit * length**3 / (3 * E / 12)
    for ratio in (1.2, 1.45):
        model = ct.Model(mesh)
        law = ct.Mises(E=E, nu=0.0, yield_stress=sy)
        model.section("all", element="Q8R", material=law)
        model.fix("left")
        model.traction("right", y=-ratio * limit)
        results = ct.solve(model, ct.Static(nlgeom=False, increments=10), threads=1)
        tip = -results.frames[-1].U[mesh.nodes_of("right"), 1].mean()
        q = np.sqrt(3 - 2 * ratio)
        exact = (5 - (3 + ratio) * q) / ratio**2
        assert tip / elastic == pytest.approx(exact, rel=0.01)


def test_bar_under_cycles() -> None:
    """Saw-tooth strain on a bar: the hysteresis loops of both kinds of hardening."""
    E, sy, H = 200000.0, 250.0, 5000.0
    slope = E * H / (E + H)
    for kind in ("isotropic", "kinematic"):
        model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 1))
        law = ct.Mises(E=E, nu=0.3, yield_stress=sy, **{kind: H})
        model.section("all", element="Q4I", material=law)
        model.fix("left", y=None)
        model.fix("bottom", x=None)
        steps = []
        for target in (0.005, -0.005, 0.005):
            support = ct.model.Fixed(model.mesh.nodes_of("right"), 0, 2 * target)
            steps.append(ct.Static(nlgeom=False, increments=5, supports=[support]))
        results = ct.solve(model, steps, threads=1)
        s = [f.fields[0].values["S"][0, 0, 0] for f in results.frames if f.factor == 1.0]
        top = sy + slope * (0.005 - sy / E)
        size = top if kind == "isotropic" else sy
        below = top - 2 * size - slope * (0.01 - 2 * size / E)
        assert s[0] == pytest.approx(top, rel=1e-9)
        assert s[1] == pytest.approx(below, rel=1e-9)
        if kind == "kinematic":
            assert s[2] == pytest.approx(top, rel=1e-9)


pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")

NOTCH = (2 + np.pi) / 3**0.5


@pytest.mark.parametrize(
    ("element", "mean", "meshes", "within"),
    [
        ("Q4", True, (4, 8), 0.01),
        ("Q4D", True, (8, 12), 0.01),
        ("Q8", False, (4, 8), 0.01),
        ("Q8R", False, (4, 8), 0.013),
        ("Q4I", False, (4, 8), 0.01),
    ],
)
def test_double_notch_does_not_lock(
    element: str, mean: bool, meshes: tuple[int, int], within: float
) -> None:
    """Limit load (2 + pi)/sqrt 3 on the ligament, approached with the mesh."""
    errors = []
    for n in meshes:
        pull = 0.2 if element == "Q8R" else 0.15
        model = notched(element, n, pull, mean_dilatation=mean)
        results = ct.solve(model, ct.Static(nlgeom=False, increments=10), threads=1)
        top = find(model.mesh, 1, 15.0)
        errors.append(abs(results.frames[-1].RF[top, 1].sum() / 450.0 / NOTCH - 1.0))
    assert errors[1] < within, errors
    assert errors[1] < 0.7 * errors[0], errors
