"""Stress output in large strain: Cauchy stress, with the thickness after deformation."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota.model.steps import Static
from support.continuum import moduli
from support.models import boundary, cell, prescribe

E, NU = 210.0, 0.3
STRESS = 1e-11


def distorted(element, seed):
    mesh = ct.mesh.rectangle(3.0, 2.0, 3, 3, cell(element), "alternate")
    return ct.mesh.distort(mesh, 0.3, seed=seed)


def point_values(results, name):
    return np.concatenate([f.values[name].reshape(-1, 4) for f in results.frames[-1].fields])


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9"])
def test_green_lagrange_gives_cauchy_stress_of_a_large_stretch(element, plane):
    """S is Cauchy stress: F S F^T / J with the thickness after deformation in J."""
    mesh = distorted(element, 5)
    model = ct.Model(mesh)
    material = ct.Elastic(E=E, nu=NU)
    model.section(
        "all", element=element, material=material, local_strain="green_lagrange", plane=plane
    )
    f = np.array([[1.2, 0.1], [-0.05, 0.9]])
    edge = boundary(mesh)
    prescribe(model, edge, (mesh.points @ f.T - mesh.points)[edge])
    results = ct.solve(model, Static(tolerance=1e-12), threads=1)
    green = 0.5 * (f.T @ f - np.eye(2))
    s = moduli(E, NU, plane) @ [green[0, 0], green[1, 1], 2 * green[0, 1]]
    pk2 = np.array([[s[0], s[2]], [s[2], s[1]]])
    if plane == "stress":
        thick = np.sqrt(1 - 2 * NU / (1 - NU) * np.trace(green))
        through = 0.0
    else:
        thick = 1.0
        through = NU * (s[0] + s[1]) / np.linalg.det(f)
    cauchy = f @ pk2 @ f.T / (np.linalg.det(f) * thick)
    expected = np.array([cauchy[0, 0], cauchy[1, 1], through, cauchy[0, 1]])
    found = point_values(results, "S")
    assert np.abs(found - expected).max() <= STRESS * np.abs(expected).max()


@pytest.mark.parametrize("plane", ["stress", "strain"])
@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9"])
def test_logarithmic_gives_cauchy_stress_of_a_large_stretch(element, plane):
    """Hencky's law: Kirchhoff stress C : ln V over the volume ratio."""
    mesh = distorted(element, 5)
    model = ct.Model(mesh)
    material = ct.Elastic(E=E, nu=NU)
    model.section(
        "all", element=element, material=material, local_strain="logarithmic", plane=plane
    )
    f = np.array([[1.2, 0.1], [-0.05, 0.9]])
    edge = boundary(mesh)
    prescribe(model, edge, (mesh.points @ f.T - mesh.points)[edge])
    results = ct.solve(model, Static(tolerance=1e-12, increments=2), threads=1)
    squared, axes = np.linalg.eigh(f @ f.T)
    hencky = axes @ np.diag(0.5 * np.log(squared)) @ axes.T
    s = moduli(E, NU, plane) @ [hencky[0, 0], hencky[1, 1], 2 * hencky[0, 1]]
    if plane == "stress":
        thick, through = np.exp(-NU / (1 - NU) * np.trace(hencky)), 0.0
    else:
        thick, through = 1.0, NU * (s[0] + s[1])
    expected = np.array([s[0], s[1], through, s[2]]) / (np.linalg.det(f) * thick)
    found = point_values(results, "S")
    assert np.abs(found - expected).max() <= STRESS * np.abs(expected).max()
