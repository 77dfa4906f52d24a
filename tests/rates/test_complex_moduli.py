"""Harmonic response of viscoelastic materials: complex moduli of a Prony series.

Closed forms: a bar with a mass moves by ``F / (M* A / L - w^2 m)``; a slender cantilever has the
response of Bernoulli's beam with ``E* = 9 K* G* / (3 K* + G*)`` (J. D. Ferry, *Viscoelastic
Properties of Polymers*, 1980).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

import corota as ct

E, NU = 2000.0, 0.38
TERMS = [(0.3, 0.05, 0.02), (0.2, 0.1, 0.5)]
POLYMER = ct.Viscoelastic(ct.Elastic(E=E, nu=NU, rho=1e-9), terms=TERMS)


def moduli(frequency: float, terms: Any = TERMS) -> tuple[complex, complex]:
    """Shear and bulk modulus by their definition."""
    w = 2.0 * math.pi * frequency
    shear, bulk = E / (2.0 * (1.0 + NU)), E / (3.0 * (1.0 - 2.0 * NU))
    g, k = (
        1.0
        - sum(t[i] for t in terms)
        + sum(t[i] * 1j * w * t[2] / (1 + 1j * w * t[2]) for t in terms)
        for i in (0, 1)
    )
    return shear * g, bulk * k


def response(frame: Any, node: int, component: int) -> complex:
    """Complex amplitude: displacement, and velocity over minus the circular frequency."""
    w = 2.0 * math.pi * frame.scalars["frequency"]
    return complex(frame.U[node, component], -frame.V[node, component] / w)


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8R", "T6", "Q4D"])
@pytest.mark.parametrize("plane", ["stress", "strain"])
def test_a_bar_carries_a_mass(element: str, plane: str) -> None:
    """With its sides held, so that nothing moves across; by the whole model and by modes."""
    kind = {"Q8R": "quad8", "T6": "tri6"}.get(element, "quad4")
    length, mass = 10.0, 0.4
    mesh = ct.mesh.rectangle(length, 2.0, nx=1, ny=1, cell=kind)
    model = ct.Model(mesh)
    model.section("all", element=element, material=POLYMER, thickness=3.0, plane=plane)
    model.fix("left", x=0.0, y=None)
    model.fix(np.arange(mesh.n_nodes), x=None, y=0.0, rotation=True if element == "Q4D" else None)
    right = mesh.nodes_of("right")
    # Shares of a quadratic side.
    share = np.full(len(right), 1.0 / len(right))
    if len(right) == 3:
        share = np.where(np.isclose(mesh.points[right, 1], 1.0), 2.0 / 3.0, 1.0 / 6.0)
    for node, part in zip(right, share, strict=True):
        model.point_mass([node], mass * part)
        model.force([node], x=part)
    sweep = {"lowest": 1.0, "highest": 9.0, "points": 5}
    whole = ct.solve(model, ct.SteadyState(**sweep, direct=True))
    modal = ct.solve(model, [ct.Frequency(modes=1), ct.SteadyState(**sweep)])
    assert any("complex moduli" in note for note in whole.notes)
    assert any("instantaneous moduli count" in note for note in modal.notes)
    for results in (whole, modal):
        frames = [f for f in results.frames if "largest amplitude" in f.scalars]
        assert len(frames) >= 5
        for frame in frames:
            f = frame.scalars["frequency"]
            shear, bulk = moduli(f)
            stiff = bulk + 4.0 / 3.0 * shear
            if plane == "stress":
                stiff = 4.0 * shear * (3.0 * bulk + shear) / (3.0 * bulk + 4.0 * shear)
            expected = 1.0 / (stiff * 6.0 / length - (2.0 * math.pi * f) ** 2 * mass)
            for node in right:
                assert abs(response(frame, node, 0) - expected) < 2e-6 * abs(expected)


@pytest.mark.parametrize("terms", [[(0.2, 0.2, 0.002)], [(0.3, 0.05, 0.002), *TERMS[1:]]])
def test_resonance_of_a_damped_flexure(terms: Any) -> None:
    """The tip of a slender cantilever shaken at its foot, beside Bernoulli's beam of modulus E*."""
    length, height, thick, rho = 60.0, 2.0, 5.0, 1.2e-9
    material = ct.Viscoelastic(ct.Elastic(E=E, nu=NU, rho=rho), terms=terms)
    mesh = ct.mesh.rectangle(length, height, nx=12, ny=1, cell="quad8")
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=material, thickness=thick)
    model.fix("left", x=0.0, y=None)
    model.fix("left", x=None, y=1.0)
    step = ct.SteadyState(lowest=60.0, highest=160.0, points=51, direct=True)
    results = ct.solve(model, step)
    tip = int(np.argmin(np.hypot(*(mesh.points - [length, 0.5 * height]).T)))
    found, expected = [], []
    for frame in results.frames:
        if "largest amplitude" not in frame.scalars:
            continue
        f = frame.scalars["frequency"]
        shear, bulk = moduli(f, terms)
        modulus = 9.0 * bulk * shear / (3.0 * bulk + shear)
        bending = modulus * thick * height**3 / 12.0
        a = length * (rho * thick * height * (2.0 * math.pi * f) ** 2 / bending) ** 0.25
        # Relative motion of the free end of a clamped beam whose foot moves by one.
        expected.append((cmath.cos(a) + cmath.cosh(a)) / (1.0 + cmath.cos(a) * cmath.cosh(a)))
        found.append(response(frame, tip, 1))
    peak = np.abs(expected).max()
    assert 3.0 < peak < 40.0
    # Shear and the mesh move the resonance by less than half a percent.
    assert np.abs(found).max() == pytest.approx(peak, rel=3e-2)
    assert abs(int(np.argmax(np.abs(found))) - int(np.argmax(np.abs(expected)))) <= 1
    loss = np.abs(np.array(found).imag).max()
    assert loss == pytest.approx(np.abs(np.array(expected).imag).max(), rel=3e-2)


def test_moduli_of_the_long_term_and_of_short_times() -> None:
    material = ct.Viscoelastic(
        ct.Elastic(E=E, nu=NU),
        terms=TERMS,
        shift=ct.WLF(C1=10.0, C2=60.0, T0=20.0),
        temperature=30.0,
    )
    factor = 10.0 ** (-10.0 * 10.0 / 70.0)
    g, k = material.complex_moduli([1e-9, 3.0, 1e12])
    assert g[[0, 2]] == pytest.approx([0.5, 1.0], abs=1e-6)
    assert k[[0, 2]] == pytest.approx([0.85, 1.0], abs=1e-6)
    hand = 1.0 - sum(t[0] / (1.0 + 3.0j * t[2] * factor) for t in TERMS)
    assert g[1] == pytest.approx(hand, rel=1e-12)
