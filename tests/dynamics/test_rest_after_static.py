"""A static state under gravity and spin is one of rest for the motion that follows.

The class of defect: body forces of the static step on another mass field than the inertia's, so
that the step that moves starts out of balance (contact force between 1.6 and 2.4 for 2).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.analysis.terms.moving_mass import MovingMass, masses_of_steps
from support.models import cell

#: Every cell shape, with and without rotations.
KINDS = ["T3", "T6", "Q4I", "Q8", "OPT", "Q4D"]


def block(element: str) -> ct.Model:
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 3, 2, cell(element)), 0.15)
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(1e3, 0.3, rho=2.0), thickness=0.5)
    model.gravity(y=-10.0)
    return model


def drift(model: ct.Model, step: ct.Dynamic) -> tuple[float, list[ct.Frame]]:
    """Largest displacement from the state of rest over the largest one in it."""
    frames = ct.solve(model, [ct.Static(tolerance=1e-11), step], fields=False).frames
    rest = next(f for f in reversed(frames) if f.step == 1)
    moving = [f for f in frames if f.step == 2]
    far = max(float(np.abs(f.U - rest.U).max()) for f in moving)
    return far / float(np.abs(rest.U).max()), moving


@pytest.mark.parametrize("mass", ["consistent", "constant", "lumped"])
@pytest.mark.parametrize("element", KINDS)
def test_a_hanging_block_stays_at_rest(element: str, mass: str) -> None:
    model = block(element)
    model.fix("top")
    step = ct.Dynamic(period=0.2, increments=4, scheme="newmark", mass=mass)
    assert drift(model, step)[0] <= 1e-8


@pytest.mark.parametrize("element", KINDS)
def test_a_block_on_a_wall_stays_at_rest(element: str) -> None:
    """The force of the wall is the weight: 2 x 1 x .5 x 2 x 10."""
    model = block(element)
    model.fix("left", x=0.0, y=None)
    model.contact("bottom", ct.RigidCurve.line((-1.0, 0.0), (3.0, 0.0)), name="wall")
    far, moving = drift(model, ct.Dynamic(period=0.2, increments=4, scheme="newmark"))
    assert far <= 1e-7
    for frame in moving[1:]:
        assert frame.scalars["wall: force y"] == pytest.approx(20.0, rel=1e-6)


def test_explicit_motion_starts_from_rest() -> None:
    model = block("Q8")
    model.fix("top")
    step = ct.Dynamic(period=0.02, scheme="central_difference")
    assert drift(model, step)[0] <= 1e-8


def test_the_mass_is_that_of_the_next_motion() -> None:
    """Else that of the last one; statics alone has the consistent one."""
    still = ct.Static()
    lumped = ct.Dynamic(mass="lumped", redistribute=False)
    plain = ct.Dynamic()
    steps = [still, lumped, still, plain, still]
    kinds = [mass.kind for mass in masses_of_steps(steps)]
    assert kinds == ["lumped", "lumped", "consistent", "consistent", "consistent"]
    assert masses_of_steps(steps)[4].redistribute
    assert masses_of_steps([still]) == [MovingMass()]
