"""A ring that flows, beside a one-dimensional program that shares no code with the core.

A long ring is pulled or pressed along its axis, with pressures on its faces: all depends on the
radius alone. The program has linear elements along the radius, principal logarithmic strains and a
radial return to an ideal von Mises cylinder, in the same increments.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct

INNER, OUTER, HEIGHT = 5.0, 15.0, 8.0
E, NU, YIELD = 210e3, 0.3, 240.0
SHEAR, BULK = E / (2.0 + 2.0 * NU), E / (3.0 - 6.0 * NU)
PART = np.eye(3) - 1.0 / 3.0


def stress(strain, plastic):
    """Stress, plastic strain and tangent, in principal directions."""
    elastic = BULK * np.ones((3, 3)) + 2.0 * SHEAR * PART
    trial = elastic @ (strain - plastic)
    s = trial - trial.mean()
    mises = np.sqrt(1.5 * (s @ s))
    if mises <= YIELD:
        return trial, plastic, elastic
    flow = (mises - YIELD) / (3.0 * SHEAR)
    direction = 1.5 * s / mises
    tangent = BULK * np.ones((3, 3)) + 2.0 * SHEAR * (1.0 - 3.0 * SHEAR * flow / mises) * PART
    tangent += 6.0 * SHEAR**2 * (flow / mises - 1.0 / (3.0 * SHEAR)) * np.outer(s, s) / (s @ s)
    return trial - 2.0 * SHEAR * flow * direction, plastic + flow * direction, tangent


def radial(path, increments, finite, n=40):
    """Displacements of the faces after steps to (axial strain, inner, outer pressure)."""
    r = np.linspace(INNER, OUTER, n + 1)
    u, plastic, before = np.zeros(n + 1), np.zeros((n, 2, 3)), np.zeros(3)
    for end in path:
        for part in np.arange(1, increments + 1) / increments:
            axial, bore, wall = before + (np.array(end) - before) * part
            along = 1.0 + axial if finite else 1.0
            for _ in range(60):
                moved = r + u if finite else r
                out, k, new = np.zeros(n + 1), np.zeros((n + 1, n + 1)), np.zeros_like(plastic)
                out[0], out[-1] = -bore * moved[0] * along, wall * moved[-1] * along
                if finite:
                    k[0, 0], k[-1, -1] = -bore * along, wall * along
                for e in range(n):
                    h = r[e + 1] - r[e]
                    for g, xi in enumerate((-(3.0**-0.5), 3.0**-0.5)):
                        shape = np.array([1.0 - xi, 1.0 + xi]) / 2.0
                        at = shape @ r[e : e + 2]
                        b = np.array([[-1.0 / h, 1.0 / h], shape / at])
                        stretch = 1.0 + b @ u[e : e + 2] if finite else np.ones(2)
                        strain = np.append(b @ u[e : e + 2], axial)
                        if finite:
                            strain = np.log(np.append(stretch, along))
                        s, new[e, g], c = stress(strain, plastic[e, g])
                        own = c[:2, :2] / np.outer(stretch, stretch)
                        own -= np.diag(s[:2] / stretch**2) if finite else 0.0
                        out[e : e + 2] += b.T @ (s[:2] / stretch) * h / 2.0 * at
                        k[e : e + 2, e : e + 2] += b.T @ own @ b * h / 2.0 * at
                if np.abs(out).max() < 1e-9 * YIELD * OUTER:
                    break
                u = u - np.linalg.solve(k, out)
            plastic = new
        before = np.array(end)
    return u[0], u[-1]


@pytest.mark.parametrize(
    ("element", "path", "increments", "finite"),
    [
        ("Q4S", [(-0.002, 27.0, 0.0)], 1, False),
        ("Q8R", [(-0.002, 27.0, 0.0), (-0.002, -27.0, -27.0)], 10, False),
        ("Q4I", [(-0.002, 27.0, 0.0), (-0.002, 27.0, -27.0)], 10, True),
        ("Q8R", [(-0.04, 27.0, 0.0)], 10, True),
        ("Q4S", [(0.04, 27.0, 0.0), (0.02, 0.0, 27.0)], 10, True),
    ],
    ids=["one increment", "reversed", "unloaded", "pressed", "pulled and back"],
)
def test_ring_beside_a_program_of_one_dimension(element, path, increments, finite):
    cell = "quad8" if element == "Q8R" else "quad4"
    mesh = ct.mesh.rectangle(OUTER - INNER, HEIGHT, nx=20, ny=1, cell=cell)
    mesh.points[:, 0] += INNER
    model = ct.Model(mesh)
    steel = ct.Mises(E, NU, yield_stress=YIELD)
    model.section("all", element=element, material=steel, plane="axisymmetric")
    model.fix("bottom", x=None)
    steps = []
    for axial, bore, wall in path:
        step = ct.Static(nlgeom=finite, increments=increments)
        step.fix("top", x=None, y=axial * HEIGHT)
        step.pressure("left", bore)
        step.pressure("right", wall)
        steps.append(step)
    results = ct.solve(model, steps, threads=1)
    found = [results.history("U1", at=side)[-1] for side in ("left", "right")]
    exact = np.array(radial(path, increments, finite))
    # The linear elements along the radius converge with their number.
    np.testing.assert_allclose(found, exact, rtol=0, atol=1.5e-3 * np.abs(exact).max())
