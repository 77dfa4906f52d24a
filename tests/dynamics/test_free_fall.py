"""Free fall: what moves is what is heavy, so nothing is stressed.

The class of defect: gravity on another mass field than the inertia's.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.models import ELEMENTS, cell
from support.pairs import cover

G = 10.0


def body(element: str) -> ct.Model:
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 3, 2, cell(element)), 0.2)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(1e5, 0.3, rho=2.0), thickness=0.5)
    model.gravity(x=0.3 * G, y=-G)
    return model


def stress(frame: ct.Frame) -> float:
    """Largest stress over rho g h."""
    return max(float(np.abs(b.values["S"]).max()) for b in frame.fields) / (2.0 * G)


@pytest.mark.parametrize(
    ("element", "mass", "scheme"),
    cover(ELEMENTS, ["consistent", "constant", "lumped"], ["newmark", "hht", "energy_momentum"]),
)
def test_free_fall_is_free_of_stress(element: str, mass: str, scheme: str) -> None:
    """Up to 4.3 of rho g h before, with lumped masses and drilling elements."""
    model = body(element)
    model.velocity(x=2.0, y=5.0)
    step = ct.Dynamic(period=0.2, increments=4, fixed_increments=True, mass=mass, scheme=scheme)
    frame = ct.solve(model, step, fields=True).frames[-1]
    fallen = np.array([0.4 + 0.3 * G * 0.02, 1.0 - G * 0.02])
    assert np.abs(frame.U - fallen).max() <= (1e-9 if scheme != "hht" else 1e-3)
    assert stress(frame) <= 1e-6


@pytest.mark.parametrize("mass", ["consistent", "constant", "lumped"])
@pytest.mark.parametrize("element", ["Q8", "Q4D", "OPT"])
def test_a_spinning_body_falls_as_it_floats(element: str, mass: str) -> None:
    """Gravity changes no displacement relative to the mass center, nor any stress."""
    ends = []
    for falls in (True, False):
        model = body(element)
        if not falls:
            model.loads.clear()
        model.velocity(spin=3.0, about=(1.0, 0.5))
        step = ct.Dynamic(
            period=0.4, increments=8, fixed_increments=True, mass=mass, scheme="energy_momentum"
        )
        ends.append(ct.solve(model, step, fields=True).frames[-1])
    fallen = 0.5 * 0.4**2 * np.array([0.3 * G, -G])
    assert np.abs(ends[0].U - fallen - ends[1].U).max() <= 1e-8
    assert abs(stress(ends[0]) - stress(ends[1])) <= 1e-5


@pytest.mark.parametrize(
    ("element", "mass", "scheme"),
    cover(
        ELEMENTS,
        ["consistent", "constant", "lumped"],
        ["newmark", "hht", "generalized_alpha", "energy_momentum"],
    ),
)
def test_a_block_with_a_contact_pair_that_it_never_touches(
    element: str, mass: str, scheme: str
) -> None:
    """Gravity acts on the redistributed mass: no stress, no turn (8.3 degrees before)."""
    mesh = ct.mesh.move(ct.mesh.rectangle(1.0, 1.0, 3, 3, cell(element)), (0.0, 20.0), angle=30.0)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(1e5, 0.3, rho=1.0))
    model.contact("bottom", ct.RigidCurve.line((-50.0, -30.0), (50.0, -30.0)))
    model.gravity(x=0.3 * G, y=-G)
    model.velocity(x=1.0, y=2.0)
    step = ct.Dynamic(period=0.2, increments=4, fixed_increments=True, mass=mass, scheme=scheme)
    frame = ct.solve(model, step, fields=True).frames[-1]
    assert np.abs(frame.U - [0.2 + 0.006 * G, 0.4 - 0.02 * G]).max() <= 1e-9
    assert stress(frame) <= 1e-7


@pytest.mark.parametrize("mass", ["consistent", "lumped"])
@pytest.mark.parametrize("element", ["T3", "Q4I", "Q8", "OPT", "Q4D"])
def test_mass_moved_off_the_skin_shifts_the_center_with_the_square_of_the_element(
    element: str, mass: str
) -> None:
    """Mass is kept; its center, seen by the angular momentum of a translation, converges."""
    shifts = []
    for n in (2, 4, 8):
        model = ct.Model(ct.mesh.rectangle(1.0, 1.0, n, n, cell(element)))
        model.section("all", element=element, material=ct.Elastic(1e5, 0.3, rho=1.0))
        model.contact("bottom", ct.RigidCurve.line((-50.0, -30.0), (50.0, -30.0)))
        model.velocity(x=1.0)
        step = ct.Dynamic(period=1e-6, increments=1, mass=mass)
        scalars = ct.solve(model, step, fields=False).frames[-1].scalars
        assert abs(scalars["momentum x"] - 1.0) <= 1e-12
        shifts.append(abs(-scalars["angular momentum"] - 0.5))
    assert shifts[0] <= 0.15
    assert shifts[1] <= 0.30 * shifts[0] + 1e-12
    assert shifts[2] <= 0.28 * shifts[1] + 1e-12
