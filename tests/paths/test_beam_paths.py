"""Paths of beams in any unit, and frames under following pressure; limit loads: the catalog."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

import corota as ct
from corota.verification import beam_models
from support.frames import node_at


def limits(model: ct.Model, node: int, end: float, first: float = 0.0) -> list[float]:
    path = ct.ArcLength(displacement=(node, "y", end))
    step = ct.Static(path=path, first_increment=first)
    results = ct.solve(model, step, fields=False, threads=1)
    assert {p.kind for p in results.critical_points} == {"limit"}
    return [p.factor for p in results.critical_points]


def test_meters_millimeters_and_any_first_increment_give_the_same_path() -> None:
    plain = limits(*beam_models.lee_frame(10), -62.0)
    for scale in (1e-3, 1e3):
        model, node = beam_models.lee_frame(10, scale=scale)
        assert limits(model, node, -62.0 * scale) == pytest.approx(plain, rel=1e-6)
    for first in (0.001, 1.5):
        assert limits(*beam_models.lee_frame(10), -62.0, first) == pytest.approx(plain, rel=1e-6)


def test_limit_points_of_beams_converge_with_the_square_of_their_length() -> None:
    exact = np.array([33.847716, 31.246220])
    errors = [
        np.array(limits(*beam_models.williams_toggle(n), -0.7)) / exact - 1.0 for n in (10, 20)
    ]
    order = np.log2(errors[0] / errors[1])
    assert order == pytest.approx(2.0, abs=0.1)


def test_a_path_goes_on_where_its_limit_point_has_no_inverse() -> None:
    """An equilibrium within rounding of the limit point: its neighbors locate it."""
    model, node = beam_models.deep_arch(160)
    found = limits(model, node, -124.0)
    assert found == pytest.approx([0.89728913, -0.073055], rel=2e-3)


@pytest.mark.parametrize("scale", [1.0, 1e-3])
def test_von_mises_truss_in_both_units(scale: float) -> None:
    model, node = beam_models.von_mises_truss(2.0, scale)
    found = limits(model, node, -4.4 * scale)
    assert found == pytest.approx(beam_models.von_mises_limits(2.0), rel=1e-9)


def follower_cantilever(pressure: float, stiffness: float, length: float) -> np.ndarray:
    """Tip of an inextensible cantilever under a uniform load normal to its deformed line.

    ``EI theta'' = -(V n)``: with the force of what lies beyond s, ``F' = -p n``, and
    ``M' = -F x t``; solved as a boundary value problem.
    """

    def rates(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        theta, moment, fx, fy = y[:4]
        c, s = np.cos(theta), np.sin(theta)
        # Load per length along the left normal (-s, c).
        return np.array([moment / stiffness, -(c * fy - s * fx), pressure * s, -pressure * c, c, s])

    def ends(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return np.array([a[0], a[4], a[5], b[1], b[2], b[3]])

    s = np.linspace(0.0, length, 201)
    found = solve_bvp(rates, ends, s, np.zeros((6, len(s))), tol=1e-9, max_nodes=20000)
    assert found.success
    return np.array([found.y[4, -1] - length, found.y[5, -1]])


def test_following_pressure_on_a_strip_against_the_elastica() -> None:
    """Non-conservative (open end); large turning, thin strip, by the path."""
    length, depth, young, pressure = 10.0, 0.02, 1.5e9, 6.0
    mesh = ct.mesh.rectangle(length, depth, nx=60, ny=1, cell="quad8", origin=(0.0, -depth / 2))
    model = ct.Model(mesh)
    model.section("all", element="Q8", material=ct.Elastic(E=young, nu=0.0))
    model.fix("left")
    # Half on each side: their stretches cancel.
    model.pressure("bottom", 0.5 * pressure)
    model.pressure("top", -0.5 * pressure)
    path = ct.ArcLength(factor=1.0)
    results = ct.solve(model, ct.Static(path=path), fields=False, threads=1)
    exact = follower_cantilever(pressure, young * depth**3 / 12.0, length)
    corners = [node_at(mesh, length, y) for y in (-depth / 2, depth / 2)]
    found = results.frames[-1].U[corners].mean(axis=0)
    assert abs(exact[0]) > 2.0
    assert found == pytest.approx(exact, rel=2e-3)
    assert "stable" not in results.frames[-1].scalars


def test_ring_under_following_pressure_buckles_at_three() -> None:
    """``p R^3 / EI = 3`` (Levy 1884); the work of the pressure is that on the area lost."""
    radius, depth = 50.0, 1.0
    mesh = ct.mesh.annulus(
        radius - depth / 2, radius + depth / 2, n_radial=1, n_around=40, angle=90.0, cell="quad9"
    )
    model = ct.Model(mesh)
    model.section("all", element="Q9", material=ct.Elastic(E=12e4, nu=0.0))
    model.fix("start", x=None)
    model.fix("end", y=None)
    model.pressure("outer", 1.0)
    factor = ct.solve(model, ct.Buckle(), threads=1).modes[0].factors[0]
    assert factor * radius**3 / (12e4 * depth**3 / 12.0) == pytest.approx(3.0, rel=4e-3)
