"""Strain at large deformation has the axes of the deformed body, as the stress has."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

CELL = {"T3": "tri3", "T6": "tri6", "Q8": "quad8", "Q8R": "quad8", "Q9": "quad9"}


def homogeneous(element: str, F: np.ndarray, **section: object) -> dict[str, np.ndarray]:
    """Values at the points of a body whose nodes move by one deformation gradient."""
    mesh = ct.mesh.rectangle(2.0, 1.0, 2, 2, cell=CELL.get(element, "quad4"))
    model = ct.Model(mesh)
    model.section("all", element=element, plane="strain", **section)
    for node, (x, y) in enumerate(mesh.points @ (F - np.eye(2)).T):
        model.fix([node], x=x, y=y)
    values = ct.solve(model).frames[-1].fields[0].values
    return {name: v.reshape(-1, 4) for name, v in values.items() if v.shape[-1] == 4}


def tensor(rows: np.ndarray, shear: float = 1.0) -> np.ndarray:
    """Tensors in the plane of rows xx, yy, zz, xy."""
    xx, yy, _, xy = rows.T
    return np.stack([xx, shear * xy, shear * xy, yy], axis=-1).reshape(-1, 2, 2)


@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q4R", "Q8R"])
@pytest.mark.parametrize("strain", ["logarithmic", "green_lagrange"])
def test_strain_is_that_of_the_left_stretch(element: str, strain: str) -> None:
    """ln V or (V^2 - 1) / 2 with F = V R; the frame of a triangle is not turned by R."""
    F = np.array([[1.2, 0.5], [-0.4, 0.9]])
    material = ct.NeoHooke(1.0, 0.1) if strain == "logarithmic" else ct.Elastic(E=1.0, nu=0.3)
    found = homogeneous(element, F, material=material, local_strain=strain)
    squared, axes = np.linalg.eigh(F @ F.T)
    wanted = 0.5 * (np.log(squared) if strain == "logarithmic" else squared - 1.0)
    E, S = tensor(found["E"], 0.5), tensor(found["S"])
    assert np.abs(E - axes @ np.diag(wanted) @ axes.T).max() < 1e-12
    assert np.abs(E @ S - S @ E).max() < 1e-12  # isotropic laws: the axes of the stress


@pytest.mark.parametrize("element", ["T3", "Q4I"])
def test_plastic_strain_and_back_stress_have_the_axes_of_the_stress(element: str) -> None:
    """In one proportional increment of J2 plasticity."""
    law = ct.Mises(E=100.0, nu=0.3, yield_stress=1.0, isotropic=1.0, kinematic=2.0)
    found = homogeneous(element, np.array([[1.2, 0.3], [0.0, 0.9]]), material=law)
    S = tensor(found["S"])
    for name, shear in (("PE", 0.5), ("ALPHA", 1.0)):
        other = tensor(found[name], shear)
        assert np.abs(other).max() > 0.05
        assert np.abs(other @ S - S @ other).max() < 1e-10 * np.abs(other @ S).max()
