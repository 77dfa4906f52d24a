"""Results do not depend on the frame: Galilean and rotational invariance of every scheme.

Sources of the expected values: the same motion seen from another frame (exact), and the
conservation of momenta of a free body. Every scheme meets every element and mass with every
extra (contact pair that is never touched, point mass, damping per stiffness); the quick part has
one mass for each, going around. Damping per mass acts against the ground, so it is left out.
Bodies that rub on each other are in tests/audits/test_dynamics_contact.py.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import corota as ct
from support.models import cell
from support.pairs import cover
from support.particles import IMPLICIT as SCHEMES
from tests.support.lines import chain

ELEMENTS = ["Q4I", "Q8", "T6", "Q4D", "OPT", "BEAM"]
OTHERS = ["T3", "Q4", "Q4S", "Q4R", "Q8R", "Q9", "Q4DI"]
EXTRAS = ["plain", "contact", "point mass", "damping"]
MASSES = ["consistent", "constant", "lumped"]
SPIN, DRIFT, ANGLE = 2.0, np.array([3.0, -2.0]), 0.7
SOFT = ct.Elastic(E=200.0, nu=0.3, rho=1.0)
#: Quick: one mass for each; the other elements and masses are slow.
EVERY = [
    pytest.param(s, e, x, m, id=f"{s}-{e}-{x}-{m}", marks=[] if quick else [pytest.mark.slow])
    for i, s in enumerate(SCHEMES)
    for j, e in enumerate(ELEMENTS + OTHERS)
    for k, x in enumerate(EXTRAS)
    for n, m in enumerate(MASSES)
    for quick in [e in ELEMENTS and n == (i + j + k) % 3]
    if (e, x) != ("BEAM", "contact")
]


def turn(angle: float) -> np.ndarray:
    """Matrix of a rotation."""
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def body(element: str, extra: str, angle: float, drift: np.ndarray) -> ct.Model:
    """A free body that spins and stretches, turned about the origin, with a drift."""
    line = element == "BEAM"
    mesh = chain(3, 2.0) if line else ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell=cell(element))
    model = ct.Model(replace(mesh, points=mesh.points @ turn(angle).T))
    if line:
        model.beam(list(range(3)), material=SOFT, area=0.5, inertia=0.02)
    else:
        model.section("all", element=element, material=SOFT)
    if extra == "contact":
        model.contact("bottom", ct.RigidCurve.line((-900.0, -900.0), (900.0, -900.0)))
    elif extra == "point mass":
        model.point_mass(
            [0], 0.5, inertia=0.1 if line or element in ("Q4D", "OPT", "Q4DI") else 0.0
        )
    center = turn(angle) @ [1.0, 0.2]
    model.velocity(x=drift[0], y=drift[1], spin=SPIN, about=(center[0], center[1]))
    return model


def run(model: ct.Model, scheme: str, extra: str, mass: Any) -> Any:
    step = ct.Dynamic(
        period=0.3,
        increments=6,
        scheme=scheme,
        mass=mass,
        tolerance=1e-12,
        max_iterations=30,
        rayleigh=(0.0, 0.02 if extra == "damping" else 0.0),
    )
    frames = ct.solve(model, step, fields=False, threads=1).frames
    return frames[-1], sum(f.scalars["iterations"] for f in frames[1:])


@pytest.mark.parametrize(("scheme", "element", "extra", "mass"), EVERY)
def test_motion_in_a_frame_that_is_turned_and_drifts(
    scheme: str, element: str, extra: str, mass: str
) -> None:
    here, few = run(body(element, extra, 0.0, np.zeros(2)), scheme, extra, mass)
    model = body(element, extra, ANGLE, DRIFT)
    there, many = run(model, scheme, extra, mass)
    assert np.abs(here.U).max() > 0.5
    assert np.abs(there.U - 0.3 * DRIFT - here.U @ turn(ANGLE).T).max() <= 1e-9
    assert np.abs(there.V[:, :2] - DRIFT - here.V[:, :2] @ turn(ANGLE).T).max() <= 1e-8
    assert np.abs(there.UR - here.UR).max() <= 1e-9
    # Newton's method starts from a rigid flight: the last correction is a matter of rounding.
    assert abs(few - many) <= 6


@pytest.mark.parametrize(
    ("element", "extra"),
    # A beam has no surface.
    cover(ELEMENTS, EXTRAS, strength=1, allowed=lambda *case: case != ("BEAM", "contact")),
)
def test_a_free_spin_keeps_its_momenta(element: str, extra: str) -> None:
    """Of energy-momentum to rounding: rest of the mass center, angular momentum."""
    model = body(element, extra, 0.0, DRIFT)
    step = ct.Dynamic(
        period=1.0,
        increments=10,
        scheme="energy_momentum",
        tolerance=1e-12,
        max_iterations=30,
        rayleigh=(0.0, 0.02 if extra == "damping" else 0.0),
    )
    frames = ct.solve(model, step, fields=False, threads=1).frames[1:]
    for name in ("momentum x", "momentum y", "angular momentum"):
        values = np.array([f.scalars[name] for f in frames])
        assert np.ptp(values) <= 1e-9 * max(1.0, np.abs(values).max())
