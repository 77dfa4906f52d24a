"""Central differences with dofs that depend on others: rigid bodies, equations, local axes."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import corota as ct
from corota.errors import UnsupportedError
from tests.dynamics.test_constrained_motion import GRAVITY, flying, pendulum
from tests.dynamics.test_schemes import run
from tests.support.tied import with_nodes

SCHEME = "central_difference"


def lumped(mesh):
    """Nodal masses of squares of side 1 with a density and thickness of 1."""
    return np.bincount(mesh.cells[0].nodes.ravel(), minlength=mesh.n_nodes) / 4.0


def test_a_rigid_pendulum_is_that_of_its_lumped_masses():
    period, errors = 4.0, []
    for n in (200, 400):
        model, pivot = pendulum()
        mass = lumped(model.mesh)
        arm = model.mesh.points - model.mesh.points[pivot]
        inertia, moment = mass @ (arm**2).sum(axis=1), mass @ arm[:, 0]

        def rate(_, y, inertia=inertia, moment=moment):
            return y[1], -GRAVITY * moment / inertia * np.cos(y[0])

        exact = solve_ivp(rate, (0.0, period), (0.0, 0.0), rtol=1e-11, atol=1e-12).y[:, -1]
        results = run(model, period=period, increments=n, scheme=SCHEME)
        frame = results.frames[-1]
        errors.append(abs(frame.UR[pivot] - exact[0]))
        distance = np.hypot(*(model.mesh.points + frame.U - model.mesh.points[pivot]).T)
        assert distance == pytest.approx(np.hypot(*arm.T), abs=1e-12)
    assert errors[0] < 2e-3
    assert errors[1] == pytest.approx(errors[0] / 4.0, rel=0.05)


@pytest.mark.parametrize("kind", ["rigid", "distributing", "rigid in axes"])
def test_free_flight_keeps_its_momenta(kind):
    results = run(flying(kind, "Q4I"), period=1.0, scheme=SCHEME)
    first, last = results.frames[0].scalars, results.frames[-1].scalars
    for name in ("momentum x", "momentum y"):
        size = np.hypot(first["momentum x"], first["momentum y"])
        assert last[name] == pytest.approx(first[name], abs=1e-9 * max(size, 1.0))
    turn = [f.scalars["angular momentum"] for f in results.frames[1:]]
    assert np.ptp(turn) < 2e-3 * abs(turn[0])
    energy = [f.scalars["kinetic energy"] + f.scalars["internal work"] for f in results.frames[1:]]
    assert np.ptp(energy) < 2e-2 * energy[0]


def test_an_equation_joins_as_a_common_node_does():
    """Two bars, joined by one node or by equations, move alike."""

    def ends(joined):
        mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=1)
        if not joined:
            left = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
            right = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, origin=(2.0, 0.0))
            mesh = ct.mesh.assembly(left=left, right=right)
        model = ct.Model(mesh)
        model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
        x = mesh.points[:, 0]
        if not joined:
            a, b = (np.flatnonzero(x == 2.0).reshape(2, 2)[i] for i in (0, 1))
            for i, j in zip(a, b, strict=True):
                for dof in "xy":
                    model.equation((int(i), dof, 1.0), (int(j), dof, -1.0))
        model.fix(np.flatnonzero(x == 0.0))
        model.force(np.flatnonzero(x == 4.0), y=0.5)
        step = ct.Dynamic(period=2.0, scheme=SCHEME, increments=200)
        frame = ct.solve(model, step, threads=1).frames[-1]
        return frame.U[x == 4.0]

    assert ends(False) == pytest.approx(ends(True), rel=1e-9)


def test_a_rigid_end_moves_as_with_an_implicit_scheme():
    def tip(**keys):
        mesh = with_nodes(ct.mesh.rectangle(10.0, 1.0, nx=5, ny=1), (12.0, 0.5))
        model = ct.Model(mesh)
        model.section("all", element="Q4I", material=ct.Elastic(E=1e4, nu=0.3, rho=1.0))
        end = mesh.n_nodes - 1
        model.fix("left")
        model.rigid("right", end)
        model.point_mass([end], 2.0)
        model.force([end], y=8.0)
        return ct.solve(model, ct.Dynamic(period=1.0, **keys), threads=1).frames[-1].U[end]

    explicit = tip(scheme=SCHEME)
    implicit = tip(scheme="newmark", mass="lumped", increments=500)
    assert np.abs(explicit).max() > 0.05
    assert explicit == pytest.approx(implicit, rel=2e-3, abs=1e-5)


def test_a_driven_rigid_body_needs_the_moment_of_its_inertia():
    model, pivot = pendulum()
    model.loads.clear()
    model.amplitudes["turn"] = ct.Amplitude(np.linspace(0, 1, 201), np.linspace(0, 1, 201) ** 2)
    model.supports.clear()
    model.fix([pivot])
    model.fix([pivot], x=None, y=None, rotation=1.0, amplitude="turn")
    results = run(model, period=1.0, increments=200, scheme=SCHEME)
    arm = model.mesh.points - model.mesh.points[pivot]
    inertia = lumped(model.mesh) @ (arm**2).sum(axis=1)
    moment = results.history("RM3", at=[pivot])[100]
    assert moment == pytest.approx(2.0 * inertia, rel=1e-2)


def test_contact_of_coupled_nodes_is_refused():
    mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    model = ct.Model(with_nodes(mesh, (1.0, 2.0)))
    model.section("all", element="Q4", material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    model.rigid("top", model.mesh.n_nodes - 1)
    model.velocity("all", y=-1.0)
    floor = ct.RigidCurve.line((5.0, 3.0), (-5.0, 3.0))
    model.contact("top", floor)
    with pytest.raises(UnsupportedError, match="in contact and its motion depends"):
        run(model, period=0.1, increments=10, scheme=SCHEME)
