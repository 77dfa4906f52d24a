"""Homogeneous states of large strain and rotation beside a program of a single point."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest

import corota as ct
from support.audits import CELL, rotation
from support.homogeneous import PATH, Point, drive, hencky_cauchy, linear_cauchy
from support.pairs import cover

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


@pytest.mark.parametrize(
    ("element", "strain", "plane"), cover(CELL, ["linear", "logarithmic"], ["stress", "strain"])
)
def test_yield_unload_reverse_while_turning(element: str, strain: str, plane: str) -> None:
    """Combined hardening in states that stretch, unload and reverse while the body turns.

    Reference: the point program above, one implicit increment a step as the element makes it.
    Under `linear` the frame is the best fit to the nodes of a cell.
    """
    steel = ct.Mises(E=2000.0, nu=0.3, yield_stress=10.0, isotropic=60.0, kinematic=90.0)
    results = drive(element, steel, plane, strain, PATH)
    last = {f.step: f for f in results.frames}
    point = Point(2000.0, 0.3, 10.0, 60.0, 90.0, plane)
    mesh = results.mesh
    cell = mesh.points[mesh.cells[0].nodes[0]]
    for k, F in enumerate(PATH):
        want = linear_cauchy(point, F, cell) if strain == "linear" else hencky_cauchy(point, F)
        got = last[k + 1].fields[0].values["S"]
        assert np.abs(got - want).max() < 2e-6 * np.abs(want).max() + 1e-6, (k, got[0, 0], want)
        peeq = last[k + 1].fields[0].values["PEEQ"]
        assert np.abs(peeq - point.p).max() < 1e-8


def svk_cauchy(F: np.ndarray, E: float, nu: float, plane: str) -> np.ndarray:
    """St. Venant-Kirchhoff; in plane stress the thickness follows from S33 = 0."""
    e = (F.T @ F - np.eye(2)) / 2
    e33 = -nu / (1 - nu) * np.trace(e) if plane == "stress" else 0.0
    lam, mu = E * nu / (1 + nu) / (1 - 2 * nu), E / (2 + 2 * nu)
    S = lam * (np.trace(e) + e33) * np.eye(2) + 2 * mu * e
    S33 = lam * (np.trace(e) + e33) + 2 * mu * e33
    third = math.sqrt(1 + 2 * e33)
    J = np.linalg.det(F) * third
    sigma = F @ S @ F.T / J
    return np.array([sigma[0, 0], sigma[1, 1], S33 * third**2 / J, sigma[0, 1]])


BIG = [
    rotation(2.5 * k / 4) @ (np.eye(2) + k / 4 * np.array([[0.4, 0.3], [0.1, -0.2]]))
    for k in range(1, 5)
] + [rotation(0.8) @ np.array([[0.7, -0.2], [0.0, 1.2]])]


@pytest.mark.parametrize(
    ("element", "strain", "plane"),
    cover(CELL, ["green_lagrange", "logarithmic"], ["stress", "strain"]),
)
def test_large_elastic_strain_is_cauchy_stress(element: str, strain: str, plane: str) -> None:
    """Elastic strain of tens of percent with rotation: closed forms of both hyperelastic laws.

    The Hencky law: S = 2 T : dE/dC and Cauchy by the push-forward, thickness stretch exp(E33).
    """
    results = drive(element, ct.Elastic(E=100.0, nu=0.25), plane, strain, BIG)
    last = {f.step: f for f in results.frames}
    for k, F in enumerate(BIG):
        point = Point(100.0, 0.25, 1e9, 0.0, 0.0, plane)
        want = (
            hencky_cauchy(point, F)
            if strain == "logarithmic"
            else svk_cauchy(F, 100.0, 0.25, plane)
        )
        got = last[k + 1].fields[0].values["S"]
        assert np.abs(got - want).max() < 2e-6 * np.abs(want).max(), (k, got[0, 0], want)
