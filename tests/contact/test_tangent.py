"""The linearized equations of contact against differences of what they linearize."""

# SPDX-License-Identifier: BSD-3-Clause
import numpy as np
import pytest

import corota as ct
from corota._core import CLOSED, OPEN, SLIPPING
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from corota.analysis.terms.contact.equations import ContactEquations, linearized
from corota.analysis.terms.contact.path import ContactPathEquations
from corota.model.contact import METHODS

STEP = 1e-6


def problem(method, law, angle=0.0):
    low = ct.mesh.rectangle(3.0, 1.0, 4, 1)
    up = ct.mesh.rectangle(1.3, 0.5, 3, 1, origin=(0.7, 0.98))
    mesh = ct.mesh.assembly(low=low, up=up)
    disc = ct.mesh.add_node(mesh, 1.3, 2.45)
    model = ct.Model(mesh)
    model.section("low", element="Q4D", material=ct.Elastic(E=10.0, nu=0.3))
    model.section("up", element="Q4I", material=ct.Elastic(E=10.0, nu=0.3))
    circle = ct.RigidCurve.circle((1.3, 2.45), 1.0, reference=disc)
    model.contact("up.bottom", "low.top", method=method, friction=0.3, law=law)
    model.contact("up.top", circle, method=method, friction=0.3)
    if angle:
        model.local_axes("low.top", angle=angle)
    system = System(model, Multifrontal())
    system.begin(ct.Static(), 0.0, np.zeros(system.n_dofs), None)
    return ContactEquations(system)


@pytest.mark.parametrize("law", [None, ct.PressureLaw("linear", 20.0)])
@pytest.mark.parametrize("method", METHODS)
def test_rows_and_columns_are_derivatives(method, law):
    self = problem(method, law)
    n, m = self.n, self.term.n
    rng = np.random.default_rng(1)
    z = np.concatenate([0.01 * rng.standard_normal(n), rng.uniform(0.5, 2.0, m)])
    # Slips begin here: a row of what sticks is exact where nothing has slipped.
    self.term.u = z[:n].copy()
    at = self.evaluate(z, 1.0)
    for pair in self.term.pairs:
        pair.frozen = True
        pair.area = pair.full * 0.9
        pair.closed[:] = True
    states = []
    for pair, terms, (p, q) in self.pairs(at.contact_state):
        assert (terms.area > 0.1 * pair.full).sum() >= 2
        state = pair.states(terms, p, q)
        state[terms.area > 0.1 * pair.full] = [CLOSED, SLIPPING][pair.first > 0]
        state[terms.area <= 0.1 * pair.full] = OPEN
        states.append(state)
        self.slip_directions.append(pair.slip_direction(terms, q))

    def equations(z):
        """Force of contact and the rows of all constraints, with the states as they are."""
        touch = self.evaluate(z, 1.0).contact_state
        out = []
        each = zip(self.pairs(touch), states, self.slip_directions, strict=True)
        for (pair, terms, (p, q)), s, slip_direction in each:
            _, rp, _, rq, ratio, level = pair.rows(terms, s, p, q, slip_direction)
            out += [-rp, np.where(s == SLIPPING, q - ratio * p - level, -rq)]
        return touch.force, np.concatenate(out)

    def slope(dz):
        up, down = equations(z + STEP * dz), equations(z - STEP * dz)
        return tuple((a - b) / (2.0 * STEP) for a, b in zip(up, down, strict=True))

    coupling, *_ = linearized(self.term, at.contact_state, states, self.slip_directions)
    dz = rng.standard_normal(n + m)
    du, dp = dz[:n], dz[n:]
    force, rows = np.zeros(n), coupling.diagonal * dp
    parts = [(coupling.geometric_stiffness, du), (coupling.skew, du)]
    for part, x in (*parts, (coupling.rows, dp), (coupling.follow, dp)):
        np.add.at(force, part.rows, part.values * x[part.columns])
    back = coupling.rows
    np.add.at(rows, back.columns, back.values * du[back.rows])
    # Tractions that the matrix has not: those of open nodes, and of slipping ones, which are a
    # multiple of the pressure.
    gone = np.zeros(m, bool)
    for pair, s, slip_direction in zip(self.term.pairs, states, self.slip_directions, strict=True):
        first, second = pair.first, pair.first + pair.n
        gone[first:second], gone[second : first + pair.width] = s == OPEN, s != CLOSED
        slips = np.flatnonzero(s == SLIPPING)
        follow = pair.friction[slips] * slip_direction[slips] * dp[first + slips]
        dz[n + first : n + second][s == OPEN] = 0.0
        dz[n + second : n + first + pair.width][s != CLOSED] = 0.0
        dz[n + second + slips] = follow
    assert -slope(dz)[0] == pytest.approx(force, abs=1e-6 * np.abs(force).max())
    assert slope(dz)[1][~gone] == pytest.approx(rows[~gone], abs=1e-6 * np.abs(rows).max())


@pytest.mark.parametrize("method", METHODS)
def test_paths_predict_gaps_along_local_axes(method):
    self = ContactPathEquations(problem(method, None, angle=0.4).system, [])
    rng = np.random.default_rng(2)
    z = np.concatenate([0.01 * rng.standard_normal(self.n), np.ones(self.term.n)])
    du = rng.standard_normal(self.n)
    rates = self.gap_rates(self.evaluate(z, 1.0), du)
    move = np.concatenate([STEP * du, np.zeros(self.term.n)])
    up, down = (self.evaluate(z + sign * move, 1.0).contact_state.terms for sign in (1.0, -1.0))
    for (rate, _), a, b in zip(rates, up, down, strict=True):
        slope = (a.gap - b.gap) / (2.0 * STEP)
        assert rate == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())
