"""A term from outside the package that acts on velocities: an eddy-current brake."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.analysis.evaluation import Evaluation
from corota.analysis.terms.term import TERMS, StatePoint, Term

#: Damping of a node in the middle of the field [force*time/length], and half width of the field.
STRENGTH, WIDTH = 0.4, 1.5


class EddyBrake(Term):
    """Each node that passes a magnet at x = 0 is braked by ``c exp(-(x / w)^2) v``."""

    name = "eddy brake"

    def __init__(self, system: Any, width: float) -> None:
        self.system, self.width = system, width
        self.x, self.dofs = system.model.mesh.points[:, 0], np.flatnonzero(system.component == 0)

    def add(self, point: StatePoint, at: Evaluation) -> None:
        place = (self.x + point.u[self.dofs]) / self.width
        c, v = STRENGTH * np.exp(-(place**2)), point.v[self.dofs]
        force, slope = np.zeros((2, self.system.n_dofs))
        force[self.dofs] = c * v
        slope[self.dofs] = (point.weights[1] - 2.0 * point.weights[0] * place / self.width * v) * c
        at.add_damping(force)
        at.scale += np.abs(force)
        if len(at.values):
            self.system.pattern.add_diagonal(at.values, slope)


def flying(monkeypatch: pytest.MonkeyPatch, width: float) -> ct.Model:
    """A block 1 x 0.5 of mass 2 that flies along x from x = -6, at a velocity of 5."""
    monkeypatch.setitem(TERMS, "eddy brake", lambda system: EddyBrake(system, width))
    model = ct.Model(ct.mesh.rectangle(1.0, 0.5, 2, 1, origin=(-6.5, 0.0)), name="job")
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=4.0))
    model.fix("all", x=None, y=0.0)
    model.velocity("all", x=5.0)
    return model


@pytest.mark.filterwarnings("ignore:central differences took")
@pytest.mark.parametrize(
    "scheme", ["newmark", "hht", "generalized_alpha", "energy_momentum", "central_difference"]
)
def test_a_magnet_takes_a_momentum_that_does_not_depend_on_the_velocity(
    monkeypatch: pytest.MonkeyPatch, scheme: str
) -> None:
    """``m dv = -c(x) dx``: six nodes lose c w sqrt(pi) each, and the energy is heat."""
    step = ct.Dynamic(period=4.0, increments=200, scheme=scheme)
    if scheme == "central_difference":
        step = ct.Dynamic(period=4.0, scheme=scheme)
    results = ct.solve(flying(monkeypatch, WIDTH), step, threads=1)
    mass, lost = 2.0, 6.0 * STRENGTH * WIDTH * math.sqrt(math.pi)
    last = 5.0 - lost / mass
    momentum = results.history("momentum x")
    # Velocities of central differences are half an increment late: c dt / 2 m of the loss.
    late = 0.5 * 6.0 * STRENGTH / mass * results.frames[-1].scalars["dt"]
    near = 2e-3 + (lost * late / (mass * last) if scheme == "central_difference" else 0.0)
    assert momentum[0] == pytest.approx(mass * 5.0, rel=1e-9)
    assert momentum[-1] == pytest.approx(mass * last, rel=near)
    heat = 0.5 * mass * (25.0 - last**2)
    assert results.history("ALLVD")[-1] == pytest.approx(heat, rel=5e-3 + near)
    assert max(np.abs(results.history("energy balance error"))) < 5e-3


@pytest.mark.parametrize("scheme", ["newmark", "hht", "energy_momentum"])
def test_a_uniform_field_is_a_dashpot_at_each_node(
    monkeypatch: pytest.MonkeyPatch, scheme: str
) -> None:
    """From the first acceleration on: in one long increment, and in several."""
    for increments in (1, 5):
        found = []
        for own in (True, False):
            model = flying(monkeypatch, 1e9)
            if not own:
                monkeypatch.delitem(TERMS, "eddy brake")
                for node in range(model.mesh.n_nodes):
                    model.dashpot(node, x=STRENGTH)
            step = ct.Dynamic(period=1.0, increments=increments, scheme=scheme, tolerance=1e-12)
            results = ct.solve(model, step, threads=1)
            found.append([(f.U, f.V[:, :2], f.A[:, :2]) for f in results.frames])
        assert np.array(found[0]) == pytest.approx(np.array(found[1]), abs=1e-8)


def test_linear_procedures_have_its_damping(monkeypatch: pytest.MonkeyPatch) -> None:
    """Decay of the modes of a block on a spring, and the response at its resonance."""
    found = []
    for own in (True, False):
        model = flying(monkeypatch, 1e9)
        model.velocities.clear()
        model.fix("left", x=0.0, y=None)
        if not own:
            monkeypatch.delitem(TERMS, "eddy brake")
            for node in range(model.mesh.n_nodes):
                model.dashpot(node, x=STRENGTH)
        modes = ct.solve(model, ct.Frequency(modes=2, complex_modes=True), threads=1).modes[0]
        assert abs(np.asarray(modes.growth)).min() > 0.1
        found.append(np.concatenate([modes.factors, modes.growth]))
    assert found[0] == pytest.approx(found[1], rel=1e-9)


class OneNode(Term):
    """A force -c v along x on the nodes of a set, without energy if it is said to store some."""

    def __init__(self, system: Any, stores: bool) -> None:
        self.system, self.stores = system, stores
        self.dofs = system.dofs(system.model.mesh.node_sets["magnet"], 0)

    def add(self, point: StatePoint, at: Evaluation) -> None:
        force, slope = np.zeros((2, self.system.n_dofs))
        force[self.dofs] = STRENGTH * point.v[self.dofs]
        slope[self.dofs] = STRENGTH * point.weights[1]
        if self.stores:
            at.internal += force
        else:
            at.add_damping(force)
        at.scale += np.abs(force)
        if len(at.values):
            self.system.pattern.add_diagonal(at.values, slope)


@pytest.mark.parametrize("stores", [False, True])
def test_a_force_on_one_node_slows_a_stiff_block(
    monkeypatch: pytest.MonkeyPatch, stores: bool
) -> None:
    """``v = v0 exp(-c t / m)``; a force that is in no energy is named where energy is lost."""
    model = flying(monkeypatch, WIDTH)
    monkeypatch.setitem(TERMS, "eddy brake", lambda system: OneNode(system, stores))
    model.mesh.node_sets["magnet"] = np.array([0])
    results = ct.solve(model, ct.Dynamic(period=4.0, increments=200), threads=1)
    momentum = results.history("momentum x")
    assert momentum[-1] == pytest.approx(10.0 * math.exp(-STRENGTH / 2.0 * 4.0), rel=1e-3)
    named = [note for note in results.notes if "a force of 'user-defined term'" in note]
    assert len(named) == stores


@pytest.mark.parametrize("touches", [False, True])
def test_a_force_that_is_not_finite_is_named(
    monkeypatch: pytest.MonkeyPatch, touches: bool
) -> None:
    """The message has the name of the term, not the number of an equation alone."""
    model = flying(monkeypatch, math.nan)
    if touches:
        model.contact("bottom", ct.RigidCurve.line((-9.0, -1.0), (9.0, -1.0)))
    with pytest.raises(ct.ModelError, match="'eddy brake' is not a finite number"):
        ct.solve(model, ct.Dynamic(period=1.0, increments=2), threads=1)


class Counter(EddyBrake):
    """The same with a history: the heat so far."""

    name = "counter"

    def __init__(self, system: Any, width: float) -> None:
        super().__init__(system, width)
        self.heat, self.last = np.zeros(1), 0.0

    def add(self, point: StatePoint, at: Evaluation) -> None:
        super().add(point, at)
        assert at.damping is not None
        self.last = float(at.damping @ point.v)

    def commit(self) -> None:
        self.heat = self.heat + self.last

    def state(self) -> dict[str, object]:
        return {"heat": self.heat}

    def restore(self, state: Any) -> None:
        self.heat = state["heat"]


def test_a_checkpoint_holds_what_a_term_declares(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A run that goes on from a checkpoint ends with the same history."""
    terms: list[Counter] = []

    def make(system: Any) -> Counter:
        terms.append(Counter(system, WIDTH))
        return terms[-1]

    model = flying(monkeypatch, WIDTH)
    monkeypatch.setitem(TERMS, "eddy brake", make)
    model.steps = [ct.Dynamic(period=2.0, increments=8)]
    whole = ct.solve(model, threads=1)
    expected = terms[-1].heat.copy()
    files = ct.JobFiles(tmp_path / "job", checkpoint_every=3)
    ct.solve(model, observers=[files], threads=1)
    rest = ct.resume(tmp_path / "job" / "job", threads=1)
    assert np.array_equal(terms[-1].heat, expected)
    assert np.array_equal(rest.frames[-1].U, whole.frames[-1].U)
