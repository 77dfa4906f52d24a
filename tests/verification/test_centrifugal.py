"""Centrifugal load: a spinning annulus against the plane-stress solution."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.models import ELEMENTS, QUADRATIC, cell

#: Steel-like light alloy, 200 rad/s.
E, NU, RHO, OMEGA = 70e9, 0.3, 2700.0, 200.0
INNER, OUTER = 0.1, 0.5


def hoop(r: np.ndarray, inner: float) -> np.ndarray:
    """Hoop stress of an annulus.

    Timoshenko and Goodier, *Theory of Elasticity*, section 32.
    """
    a, b = inner, OUTER
    hole = a * a * b * b / (r * r)
    rest = a * a + b * b + hole - (1.0 + 3.0 * NU) / (3.0 + NU) * r * r
    return np.asarray((3.0 + NU) / 8.0 * RHO * OMEGA**2 * rest)


def radial(r: np.ndarray, inner: float) -> np.ndarray:
    """Radial stress of the same."""
    a, b = inner, OUTER
    hole = a * a * b * b / (r * r)
    return np.asarray((3.0 + NU) / 8.0 * RHO * OMEGA**2 * (a * a + b * b - hole - r * r))


def spinning(element: str, n: int, inner: float = INNER) -> ct.Model:
    """A quarter with its planes of symmetry."""
    mesh = ct.mesh.annulus(inner, OUTER, n_radial=n, n_around=2 * n, angle=90.0, cell=cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E, NU, rho=RHO))
    model.fix("start", x=None, rotation=True)
    model.fix("end", y=None, rotation=True)
    model.centrifugal(OMEGA)
    return model


def errors(element: str, n: int) -> tuple[float, float, float]:
    """Of the displacements at both edges, and of the stress in the mean square."""
    model = spinning(element, n)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    found = [np.hypot(*frame.U[model.mesh.nodes_of(s)].T).mean() for s in ("inner", "outer")]
    inner, outer = found[0] / 3.209142857e-5 - 1.0, found[1] / 4.011428571e-5 - 1.0
    square = whole = 0.0
    for block in frame.fields:
        x = block.points.reshape(-1, 2)
        r, stress = np.hypot(*x.T), block.values["S"].reshape(-1, 4)
        weight = block.volume.ravel()
        c, s = x.T / r
        around = s * s * stress[:, 0] + c * c * stress[:, 1] - 2.0 * c * s * stress[:, 3]
        along = c * c * stress[:, 0] + s * s * stress[:, 1] + 2.0 * c * s * stress[:, 3]
        square += weight @ ((around - hoop(r, INNER)) ** 2 + (along - radial(r, INNER)) ** 2)
        whole += weight @ (hoop(r, INNER) ** 2 + radial(r, INNER) ** 2)
    return abs(inner), abs(outer), float(np.sqrt(square / whole))


@pytest.mark.parametrize("element", ELEMENTS)
def test_spinning_annulus_converges_to_the_exact_displacement_and_stress(element: str) -> None:
    """u(a) = 32.09142857e-6, u(b) = 40.11428571e-6; hoop stress 22.464 and 5.616 MPa."""
    assert hoop(np.array([INNER, OUTER]), INNER) == pytest.approx([22.464e6, 5.616e6])
    coarse, fine = np.array(errors(element, 6)), np.array(errors(element, 12))
    print(element, coarse, fine, np.log2(coarse / fine))
    quadratic = element in QUADRATIC
    orders = np.log2(coarse / fine)
    assert orders[0] > (2.5 if quadratic else 1.3)
    assert orders[2] > (1.5 if quadratic else 0.8)
    assert fine[:2].max() < (2e-4 if quadratic else 4e-2)
    assert fine[2] < (5e-3 if quadratic else 0.12)


def test_spin_about_another_axis_adds_its_pull() -> None:
    """Two axes differ by a uniform acceleration omega^2 (x0 - x1): a gravity."""
    frames = []
    for about in ((0.0, 0.0), (0.3, -0.2)):
        mesh = ct.mesh.rectangle(1.0, 0.5, nx=4, ny=2)
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E, NU, rho=RHO))
        model.fix("left")
        model.centrifugal(OMEGA, about=about)
        model.gravity(x=OMEGA**2 * about[0], y=OMEGA**2 * about[1])
        frames.append(ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1].U)
    assert frames[1] == pytest.approx(frames[0], rel=1e-9, abs=1e-18)
