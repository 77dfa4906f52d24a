"""Local strain measures: derivatives, coalescing stretches, finite-strain stress."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import logm

import corota as ct
from corota import _core

MODULI = np.array([[2.0, 0.6, 0.0], [0.6, 2.0, 0.0], [0.0, 0.0, 0.7]])


def gradients(size: float, n: int = 40) -> np.ndarray:
    h = np.random.default_rng(3).uniform(-size, size, (n, 4))
    h[0] = 0.0
    h[1] = [size, 0.0, 0.0, size]  # equal stretches
    h[2] = [size, 1e-9, 0.0, size]
    return h


def measure(name: str, h: np.ndarray) -> dict[str, np.ndarray]:
    raw = _core.strain_measure(name, np.ascontiguousarray(h), MODULI.ravel())
    n = len(h)
    shapes = {"tangent": (n, 4, 4), "stress_derivative": (n, 4, 4), "strain": (n, 3)}
    return {k: v.reshape(shapes.get(k, (n, 4))) for k, v in raw.items()}


@pytest.mark.parametrize("size", [1e-6, 1e-3, 0.1, 0.45])
@pytest.mark.parametrize("name", ["linear", "green_lagrange", "logarithmic"])
def test_stress_and_tangent_are_derivatives(name: str, size: float) -> None:
    """To round-off, where the principal stretches coincide too."""
    m = measure(name, gradients(size))
    scale = np.abs(m["stress"]).max()
    assert np.abs(m["stress"] - m["energy_derivative"]).max() < 1e-12 * max(scale, 1e-3)
    stiff = np.abs(m["tangent"]).max()
    assert np.abs(m["tangent"] - m["stress_derivative"]).max() < 2e-12 * stiff
    assert np.abs(m["tangent"] - m["tangent"].transpose(0, 2, 1)).max() < 1e-14 * stiff


@pytest.mark.parametrize("size", [1e-3, 0.1, 0.45])
def test_logarithm(size: float) -> None:
    """Against the matrix logarithm."""
    h = gradients(size)
    strain = measure("logarithmic", h)["strain"]
    for row, e in zip(h, strain, strict=True):
        f = np.eye(2) + row.reshape(2, 2)
        log = 0.5 * logm(f.T @ f)
        assert np.abs([log[0, 0], log[1, 1], 2 * log[0, 1]] - e).max() < 1e-13


def test_series_and_closed_form_meet() -> None:
    """Just below and above the change of formula."""
    w = 0.1
    for side in (1 - 1e-12, 1 + 1e-12):
        z = np.sqrt(w * side)
        stretch = np.sqrt([1 + z, 1 - z])
        h = np.array([[stretch[0] - 1, 0.0, 0.0, stretch[1] - 1]])
        m = measure("logarithmic", h)
        assert m["strain"][0, :2] == pytest.approx(np.log(stretch), rel=1e-14)
        assert np.abs(m["tangent"] - m["stress_derivative"]).max() < 1e-12


@pytest.mark.parametrize("element", ["T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9", "OPT", "Q4D"])
@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_uniaxial_stretch_gives_true_stress(element: str, plane: str) -> None:
    """A bar pulled to 1.5 times its length: true stress E ln(stretch), or E ln / (1 - nu^2)
    with held thickness, and the force is stress times current area."""
    nu, stretch, t = 0.3, 1.5, 0.4
    kind = {"T3": "tri3", "OPT": "tri3", "T6": "tri6", "Q8": "quad8", "Q8R": "quad8", "Q9": "quad9"}
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell=kind.get(element, "quad4"))
    model = ct.Model(mesh)
    law = ct.Elastic(E=1000.0, nu=nu)
    model.section(
        "all", element=element, material=law, thickness=t, plane=plane, local_strain="logarithmic"
    )
    model.fix("left", y=None)
    model.fix("right", x=2.0 * (stretch - 1.0), y=None)
    model.fix("bottom", x=None, y=0.0)
    frame = ct.solve(model, ct.Static(increments=5), threads=1).frames[-1]
    modulus = 1000.0 / (1.0 - nu**2 if plane == "strain" else 1.0)
    across = -nu / (1.0 - nu) if plane == "strain" else -nu
    log = np.log(stretch)
    thick = t * (np.exp(across * log) if plane == "stress" else 1.0)
    area = thick * np.exp(across * log)
    kirchhoff = modulus * log
    volume = stretch * area / t
    stress = frame.fields[0].values["S"]
    assert np.abs(stress[..., 0] - kirchhoff / volume).max() < 1e-8 * modulus
    assert np.abs(stress[..., [1, 3]]).max() < 1e-8 * modulus
    if plane == "strain":
        assert np.abs(stress[..., 2] - nu * kirchhoff / volume).max() < 1e-8 * modulus
    assert np.abs(frame.fields[0].values["STH"] - thick).max() < 1e-8
    x = mesh.points[:, 0]
    force = frame.RF[x > 1.99, 0].sum()
    assert force == pytest.approx(kirchhoff / volume * area, rel=1e-8)
