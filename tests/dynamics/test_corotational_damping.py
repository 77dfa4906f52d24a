"""Damping per stiffness acts on local rates: a rigid motion is not damped, in any scheme."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from corota.analysis.terms.viscous import ViscousElements
from tests.support.lines import chain

CELLS = {"T3": "tri3", "OPT": "tri3", "T6": "tri6", "Q8": "quad8", "Q8R": "quad8", "Q9": "quad9"}
ELEMENTS = ["T3", "T6", "Q4", "Q4I", "Q8", "Q8R", "Q9", "OPT", "Q4D", "BEAM", "TRUSS"]
SCHEMES = ("newmark", "hht", "generalized_alpha", "energy_momentum")
STEEL = ct.Elastic(E=1e4, nu=0.3, rho=1.0)


def block(element):
    if element in ("BEAM", "TRUSS"):
        model = ct.Model(chain(4, 4.0))
        keys = {"inertia": 1e-2} if element == "BEAM" else {}
        getattr(model, element.lower())(list(range(4)), material=STEEL, area=0.1, **keys)
        return model
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1, cell=CELLS.get(element, "quad4")))
    model.section("all", element=element, material=STEEL)
    return model


def bent(system, angle, size=0.05):
    """A deformed and turned configuration."""
    rng = np.random.default_rng(3)
    values = np.zeros((len(system.per_node), 3))
    x = system.model.mesh.points
    moved = x + size * rng.standard_normal(x.shape)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    values[:, :2] = moved @ turn.T - x + 3.0
    values[:, 2] = angle + size * rng.standard_normal(len(x))
    return system.from_nodes(values)


@pytest.mark.parametrize("element", ELEMENTS)
def test_rigid_rates_are_not_damped_in_any_configuration(element):
    """Exactly zero by definition, at an instant and between two configurations."""
    system = System(block(element), Multifrontal())
    viscous = ViscousElements(system, 0.1)
    u = bent(system, 2.0)
    x = system.model.mesh.points + system.by_node(u)[:, :2]
    rates = np.column_stack([2.0 - 3.0 * x[:, 1], 1.0 + 3.0 * x[:, 0], np.full(len(x), 3.0)])
    values = np.zeros(len(system.pattern.indices))
    v = system.from_nodes(rates)
    force = viscous.add(u, u, v, 0.0, 1.0, values)
    random = np.random.default_rng(0).standard_normal(system.n_dofs)
    size = np.abs(viscous.add(u, u, random, 0.0, 0.0, values)).max()
    assert np.abs(force).max() < 1e-12 * size * np.abs(v).max()
    # The tangent is the matrix of the force.
    assert system.core.multiply(values, random) == pytest.approx(
        viscous.add(u, u, random, 0.0, 0.0, values), abs=1e-9 * size
    )
    # A turn of one radian about the origin between two configurations.
    turn = np.array([[np.cos(1.0), -np.sin(1.0)], [np.sin(1.0), np.cos(1.0)]])
    end = system.by_node(u)
    end[:, :2] = x @ turn.T - system.model.mesh.points
    end[:, 2] += 1.0
    end = system.from_nodes(end)
    d = end - u
    d[system.is_rotation] = 2.0 * np.tan(0.5)
    force = viscous.add(u, end, d, 1.0, 0.0, values)
    assert np.abs(force).max() < 1e-12 * size * np.abs(d).max()
    # Any force is without resultant and moment.
    f = system.by_node(viscous.add(u, u, random, 0.0, 0.0, values))
    moment = x[:, 0] @ f[:, 1] - x[:, 1] @ f[:, 0] + f[:, 2].sum()
    assert np.abs([*f[:, :2].sum(axis=0), moment]).max() < 1e-11 * size


@pytest.mark.parametrize("element", ["T3", "Q4I", "Q8", "Q4D", "TRUSS"])
def test_small_rates_meet_the_stiffness(element):
    """In the reference configuration: the stiffness of the linear problem times the rates."""
    system = System(block(element), Multifrontal())
    u = np.zeros(system.n_dofs)
    v = np.random.default_rng(1).standard_normal(system.n_dofs)
    force = ViscousElements(system, 0.1).add(u, u, v, 0.0, 0.0, np.zeros(0))
    stiffness = 0.1 * system.core.multiply(system.evaluate(u, 0.0).values, v)
    assert force == pytest.approx(stiffness, abs=1e-10 * np.abs(stiffness).max())


@pytest.mark.parametrize("scheme", SCHEMES)
def test_damped_spin_keeps_its_angular_momentum(scheme):
    """A quarter of it was lost in six turns; no viscous force has a moment.

    What is left is the scheme's own error, which is that of the undamped body.
    """
    model = block("Q4I")
    model.velocity(spin=2.0, about=(2.0, 0.5))
    step = ct.Dynamic(period=2.0, increments=80, scheme=scheme, rayleigh=(0.0, 0.01))
    frames = ct.solve(model, step, fields=False).frames[1:]
    momentum = np.array([f.scalars["angular momentum"] for f in frames])
    exact = 2.0 * 4.0 * (16.0 + 1.0) / 12.0
    limit = 1e-9 if scheme == "energy_momentum" else 2e-3
    assert np.abs(momentum / exact - 1.0).max() < limit
    assert frames[-1].scalars["damping energy"] > 0.0
