"""Bodies that turn at the start of a step, and schemes with constraints that turn."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from tests.support.pairs import cover
from tests.support.tied import with_nodes

SCHEMES = ("newmark", "hht", "generalized_alpha", "energy_momentum")
SPIN, ARM = 2.0, 2.0


def spinning(element="Q4I", kind="rigid"):
    """A free block of mass one turns about its center; its reference node is `ARM` away."""
    model = ct.Model(with_nodes(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1), (0.5 + ARM, 0.5)))
    model.section("all", element=element, material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    getattr(model, kind)(np.arange(4), 4, **({} if kind == "rigid" else {"kind": "distributing"}))
    model.velocity(spin=SPIN, about=(0.5, 0.5))
    return model


def errors(scheme, n, steps=1, element="Q4I", **keys):
    """Errors of position and momentum after one time unit; closed form: a steady turn."""
    model = spinning(element)
    keys = {"period": 1.0 / steps, "increments": n // steps, "scheme": scheme, **keys}
    frames = ct.solve(model, [ct.Dynamic(**keys) for _ in range(steps)], fields=False).frames
    exact = ARM * np.array([np.cos(SPIN) - 1.0, np.sin(SPIN)])
    momentum = max(
        np.hypot(f.scalars["momentum x"], f.scalars["momentum y"])
        for f in frames
        if "momentum x" in f.scalars
    )
    return np.abs(frames[-1].U[4] - exact).max(), momentum, frames


@pytest.mark.parametrize("element", ["Q4I", "Q4D", "T3"])
def test_first_accelerations_of_a_rigid_body_are_centripetal(element):
    """Closed form: a = -w^2 r at every node of a block that turns steadily."""
    if element == "T3":
        model = ct.Model(
            with_nodes(ct.mesh.rectangle(1.0, 1.0, nx=1, ny=1, cell="tri3"), (0.5 + ARM, 0.5))
        )
        model.section("all", element=element, material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
        model.rigid(np.arange(4), 4)
        model.velocity(spin=SPIN, about=(0.5, 0.5))
    else:
        model = spinning(element)
    step = ct.Dynamic(period=1e-4, increments=10, scheme="newmark")
    frame = ct.solve(model, step, fields=False).frames[1]
    expected = -(SPIN**2) * (model.mesh.points - 0.5)
    assert np.abs(frame.A - np.column_stack([expected, np.zeros(5)])).max() < 5e-3


@pytest.mark.parametrize(("scheme", "steps"), cover(SCHEMES, [1, 2], strength=1))
def test_free_rigid_body_turns_to_second_order(scheme, steps):
    """Closed form; linear momentum, zero, is kept to the order of the scheme.

    A second step starts while the body turns.
    """
    keys = {"alpha": -0.3} if scheme == "hht" else {"rho_inf": 0.3}
    coarse, fine = (errors(scheme, n, steps, **keys)[:2] for n in (20, 40))
    assert fine[0] < 5e-3
    assert np.log2(coarse[0] / fine[0]) > 1.85
    if scheme == "energy_momentum":
        assert fine[1] < 1e-10
    else:
        assert fine[1] < 5e-3
        assert np.log2(coarse[1] / fine[1]) > 1.7


@pytest.mark.parametrize("scheme", SCHEMES)
def test_strip_with_a_rigid_end_in_millimeters_turns(scheme):
    """Units N, mm, t, s: largest stress of a spinning rod, twice rho w^2 l^2 / 8 as it starts."""
    model = ct.Model(with_nodes(ct.mesh.rectangle(100.0, 20.0, nx=10, ny=1), (150.0, 10.0)))
    steel = ct.Elastic(E=210e3, nu=0.3, rho=7.85e-9)
    model.section("all", element="Q4I", material=steel, thickness=10.0)
    model.rigid("right", model.mesh.n_nodes - 1)
    model.velocity(spin=100.0, about=(50.0, 10.0))
    frames = ct.solve(model, ct.Dynamic(period=2e-3, increments=20, scheme=scheme)).frames
    largest = max(np.abs(f.fields[0].values["S"]).max() for f in frames)
    assert largest == pytest.approx(2.0 * 7.85e-9 * 1e4 * 1e4 / 8.0, rel=0.12)
