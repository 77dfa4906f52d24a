"""Mass redistribution: other nodes of the elements carry the mass of nodes in contact."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import Multifrontal
from corota.analysis.procedures import dynamic as dynamics
from corota.analysis.procedures.motion_start import initial_velocity
from corota.analysis.terms.inertia import Inertia
from support.pairs import quickly

CELLS = {"OPT": "tri3", "T3": "tri3", "T6": "tri6", "Q8": "quad8", "Q8R": "quad8", "Q9": "quad9"}
SIDES = (4.0, 1.0)


def flying(element: str, spin: float = 2.0) -> ct.Model:
    mesh = ct.mesh.rectangle(*SIDES, nx=8, ny=3, cell=CELLS.get(element, "quad4"))
    model = ct.Model(mesh)
    material = ct.Elastic(E=1e4, nu=0.3, rho=1.5)
    model.section("all", element=element, material=material, local_strain="green_lagrange")
    model.velocity(x=0.5, y=1.0, spin=spin, about=(1.0, 0.2))
    return model


def lower(model: ct.Model) -> np.ndarray:
    return np.abs(model.mesh.points[:, 1]) < 1e-9


@pytest.mark.parametrize("mass", ["consistent", "constant", "lumped"])
@pytest.mark.parametrize("element", ["T3", "Q4I", "Q8", "Q9", "OPT", "Q4D"])
def test_light_nodes_have_no_mass_and_none_is_lost(element, mass):
    model = flying(element)
    system = System(model, Multifrontal())
    light = lower(model)
    inertia = Inertia(system, mass, light)
    u, v = np.zeros(system.n_dofs), np.zeros(system.n_dofs)
    x = system.component == 0
    v[x] = 1.0
    kinetic, momentum, _, _, total = inertia.momenta(u, v, False)
    whole = 1.5 * SIDES[0] * SIDES[1]
    assert total == pytest.approx(whole, rel=1e-13)
    assert momentum == pytest.approx(whole, rel=1e-13)
    assert kinetic == pytest.approx(0.5 * whole, rel=1e-13)
    weightless = inertia.force(u, np.zeros_like(v), np.where(inertia.massless, 1.0, 0.0))
    assert np.abs(weightless).max() < 1e-14
    assert inertia.massless.sum() == 2 * light.sum()


EVERY = ["T3", "T6", "Q4", "Q4I", "Q4S", "Q4R", "Q8", "Q8R", "Q9", "OPT", "Q4D", "Q4DI"]


@pytest.mark.parametrize("mass", ["consistent", "constant", "lumped"])
@pytest.mark.parametrize("element", EVERY)
def test_center_and_moment_of_inertia_stay(element, mass):
    """Kinetic energies of rigid motions are those of the mass that was not moved."""
    system = System(flying(element), Multifrontal())
    points = system.model.mesh.points
    one = np.ones(len(points))
    spin = np.stack([0.3 - points[:, 1], points[:, 0] - 0.7, one], axis=1)
    rates = [np.outer(one, [1.0, 0.0, 0.0]), np.outer(one, [0.0, 1.0, 0.0]), spin]
    rates += [rates[0] + spin, rates[1] + spin]
    found = []
    for light in (None, lower(system.model)):
        inertia = Inertia(system, mass, light)
        u = np.zeros(system.n_dofs)
        found.append([inertia.momenta(u, system.from_nodes(v), False)[:4] for v in rates])
        assert not inertia.remark
    np.testing.assert_allclose(found[1], found[0], rtol=1e-11, atol=1e-11)
    # Every motion of the nodes with mass still has a kinetic energy.
    random = np.random.default_rng(3)
    for _ in range(20):
        v = np.where(inertia.massless, 0.0, random.normal(size=system.n_dofs))
        assert inertia.momenta(np.zeros_like(v), v, False)[0] > 0.0


@pytest.mark.parametrize(
    ("element", "scheme"),
    quickly(
        [
            *((e, s) for e in ("T3", "Q4I") for s in ("newmark", "hht", "energy_momentum")),
            ("OPT", "energy_momentum"),
        ],
        ("T3", "hht"),
        ("Q4I", "newmark"),
        ("OPT", "energy_momentum"),
    ),
)
def test_a_thrown_block_turns_as_without_contact(element, scheme):
    """A contact pair that is never touched: rotation and place of a stiff block by rigid body."""
    end, spin = 0.4, 2.0
    model = flying(element, spin)
    model.contact("bottom", ct.RigidCurve.line((-99.0, -90.0), (99.0, -90.0)))
    model.force([model.mesh.n_nodes - 1], x=30.0, y=10.0)
    plain = flying(element, spin)
    plain.force([plain.mesh.n_nodes - 1], x=30.0, y=10.0)
    step = ct.Dynamic(period=end, increments=80, scheme=scheme)
    turned = []
    for each in (model, plain):
        frame = ct.solve(each, step, fields=False).frames[-1]
        across = frame.U[-1] - frame.U[-9] + each.mesh.points[-1] - each.mesh.points[-9]
        turned.append([np.arctan2(across[1], across[0]), *frame.U[9:].mean(axis=0)])
    np.testing.assert_allclose(turned[0], turned[1], rtol=2e-3)


def test_a_center_that_moves_is_told():
    """One row of elements has no other place for the mass of its skin than its other skin."""
    model = ct.Model(ct.mesh.rectangle(4.0, 1.0, nx=8, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.5))
    model.contact("bottom", ct.RigidCurve.line((-9.0, -1.0), (9.0, -1.0)))
    model.velocity(x=1.0)
    results = ct.solve(model, ct.Dynamic(period=0.01, increments=1), fields=False)
    assert any("moves the center of mass" in note for note in results.notes)


@pytest.mark.parametrize("element", ["Q4", "Q8", "Q9"])
def test_affine_motion_is_carried_where_inner_nodes_allow_it(element):
    """Extrapolation of a spin: exact with inner nodes at two distances, along the edge always."""
    model = flying(element)
    system = System(model, Multifrontal())
    energy = []
    for light in (None, lower(model)):
        inertia = Inertia(system, "consistent", light)
        v = initial_velocity(system)
        energy.append(inertia.momenta(np.zeros(system.n_dofs), v, False)[0])
    assert energy[1] == pytest.approx(energy[0], rel=1e-11)


@pytest.mark.parametrize("element", ["Q4I", "Q8", "OPT", "Q4D"])
def test_conserving_scheme_conserves_with_light_nodes(element, monkeypatch):
    monkeypatch.setattr(
        dynamics, "Inertia", lambda system, kind, _: Inertia(system, kind, lower(system.model))
    )
    step = ct.Dynamic(period=0.6, increments=30, scheme="energy_momentum")
    frames = ct.solve(flying(element), step, fields=False).frames[1:]
    of = {name: np.array([f.scalars[name] for f in frames]) for name in frames[0].scalars}
    assert np.abs(of["energy balance"]).max() < 1e-10 * of["kinetic energy"][0]
    for name in ("momentum x", "momentum y", "angular momentum"):
        assert np.ptp(of[name]) < 1e-10 * np.abs(of[name][0]), name


@pytest.mark.parametrize("element", ["Q4I", "Q4D", "OPT"])
def test_nodes_without_mass_start_without_acceleration(element):
    """A ring above a plane begins to fall; closed form of the momentum: weight times time."""
    cell = "tri3" if element == "OPT" else "quad4"
    mesh = ct.mesh.annulus(0.3, 1.0, 2, 24, cell=cell, center=(0.0, 1.01))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=2e4, nu=0.3, rho=1.0))
    model.contact("outer", ct.RigidCurve.line((-10.0, 0.0), (10.0, 0.0)))
    model.gravity(y=-9.81)
    step = ct.Dynamic(period=0.012, increments=3, scheme="newmark")
    frames = ct.solve(model, step, fields=False).frames[1:]
    mass = np.pi * (1.0 - 0.09)
    for frame in frames:
        weight = 9.81 * mass * frame.time
        assert frame.scalars["momentum y"] == pytest.approx(-weight, rel=0.02)
