"""Motion under constraints: discrete derivatives, pendulums, free flight, frequencies."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import corota as ct
from corota.errors import ModelError
from tests.dynamics.test_schemes import SCHEMES, column, run
from tests.support.pairs import cover, quickly
from tests.support.tied import KINDS, beam, constrained, system_of, with_nodes

GRAVITY = 9.81


def states(system, seed):
    rng = np.random.default_rng(seed)
    pair = [0.3 * rng.standard_normal(system.n_dofs) for _ in range(2)]
    for u in pair:
        system.constraints.complete(u)
    return pair


def increments(system, begin, end):
    """Changes that forces do work on: ``2 tan(dphi / 2)`` of rotations."""
    d = end - begin
    d[system.is_rotation] = 2.0 * np.tan(0.5 * d[system.is_rotation])
    return d


def turning_equation():
    model, reference = beam()
    right = model.mesh.nodes_of("right")
    model.equation(
        (reference, "x", 1.0),
        (right[0], "rotation", 0.7),
        (right[1], "rotation", -0.4),
        (right[1], "y", 0.3),
    )
    model.equation((right[2], "rotation", 1.0), (reference, "y", 0.5), (right[0], "rotation", 2.0))
    return model


def every_kind():
    yield from (constrained(kind)[0] for kind in KINDS)
    yield turning_equation()


def test_discrete_derivatives_are_exact_between_any_two_states():
    for model in every_kind():
        system = system_of(model)
        begin, end = states(system, 2)
        d = increments(system, begin, end)
        link = system.constraints.secant(begin, end)
        assert np.abs(link.move(d) - d)[system.constraints.dependent].max() <= 1e-13
        at_one = system.constraints.secant(end, end).g - system.constraints.link(end).g
        assert abs(at_one).max() <= 1e-14


def test_rates_are_those_of_a_path():
    for model in every_kind():
        system = system_of(model)
        u, _ = states(system, 4)
        v, a = (0.5 * np.random.default_rng(k).standard_normal(system.n_dofs) for k in (5, 6))
        h = 1e-3

        def at(t, u=u, v=v, a=a, system=system):
            path = u + t * v + 0.5 * t**2 * a
            system.constraints.complete(path)
            return path

        dependent = system.constraints.dependent
        p = [at(k * h) for k in (-2, -1, 0, 1, 2)]
        rate = (p[0] - 8.0 * p[1] + 8.0 * p[3] - p[4]) / (12.0 * h)
        growth = (-p[0] + 16.0 * p[1] - 30.0 * p[2] + 16.0 * p[3] - p[4]) / (12.0 * h * h)
        system.constraints.complete_rates(u, v, a)
        assert np.abs(rate - v)[dependent].max() <= 1e-8
        assert np.abs(growth - a)[dependent].max() <= 1e-6


def pendulum(element="Q4I"):
    """A rigid block 2 x 1 on a rigid link about a pivot, released beside it."""
    mesh = with_nodes(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1), (-1.0, 0.5))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e3, nu=0.3, rho=1.0))
    pivot = mesh.n_nodes - 1
    model.rigid(np.arange(pivot), pivot)
    model.fix([pivot])
    model.gravity(y=-GRAVITY)
    return model, pivot


def swing(period):
    """Angle of a pendulum of 2 x 1, whose center is at 2 from the pivot."""
    inertia = 2.0 * (2.0**2 + 1.0) / 12.0 + 2.0 * 2.0**2
    pull = 2.0 * GRAVITY * 2.0 / inertia
    found = solve_ivp(
        lambda _, y: (y[1], -pull * np.cos(y[0])), (0.0, period), (0.0, 0.0), rtol=1e-11, atol=1e-12
    )
    return found.y[:, -1]


@pytest.mark.parametrize(
    ("scheme", "element"),
    quickly(
        [*((scheme, "Q4I") for scheme in SCHEMES), ("hht", "Q4D")],
        ("generalized_alpha", "Q4I"),
        ("energy_momentum", "Q4I"),
        ("hht", "Q4D"),
    ),
)
def test_rigid_pendulum_is_exact_to_second_order(scheme, element):
    period = 4.0
    angle, rate = swing(period)
    errors = []
    for n in (50, 100):
        model, pivot = pendulum(element)
        keys = {"scheme": scheme, "tolerance": 1e-10}
        results = run(model, period=period, increments=n, **keys)
        frame = results.frames[-1]
        errors.append(abs(frame.UR[pivot] - angle))
        assert frame.V[pivot, 2] == pytest.approx(rate, abs=60.0 / n)
        # The tangent leaves out how accelerations turn with the masters: at 0.4 rad an increment
        # it converges linearly.
        assert column(results, "iterations").max() <= 8
        if scheme == "energy_momentum":
            balance = column(results, "energy balance")
            assert np.ptp(balance) <= 1e-10 * column(results, "kinetic energy").max()
    assert np.log2(errors[0] / errors[1]) >= 1.9
    assert errors[1] < 5e-2


def test_reaction_of_a_rigid_pendulum_is_its_weight_and_pull():
    model, pivot = pendulum()
    frame = run(model, period=0.6, increments=200, scheme="newmark").frames[-1]
    angle, rate = swing(0.6)
    inertia = 2.0 * (5.0 / 12.0 + 4.0)
    growth = -2.0 * GRAVITY * 2.0 * np.cos(angle) / inertia
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-along[1], along[0]])
    force = 2.0 * 2.0 * (growth * across - rate**2 * along) + np.array([0.0, 2.0 * GRAVITY])
    assert frame.RF[pivot, :2] == pytest.approx(force, rel=1e-4)


def flying(kind, element):
    model, reference = constrained(kind, element)
    model.sections[0].material = ct.Elastic(E=1e3, nu=0.3, rho=1.0)
    if kind in ("rigid", "distributing"):
        model.point_mass([reference], 0.5, inertia=0.1 if kind == "rigid" else 0.0)
    if kind == "chain":
        model.point_mass([reference + 1], 0.3)
    model.velocity(spin=1.0, x=0.3, about=(1.0, 0.0))
    return model


@pytest.mark.parametrize(
    ("kind", "element"),
    cover(["rigid", "distributing", "rigid in axes"], ["Q4I", "Q4D"], strength=1),
)
def test_free_flight_with_constraints_keeps_energy_and_momenta(kind, element):
    results = run(
        flying(kind, element),
        period=2.0,
        increments=40,
        scheme="energy_momentum",
        tolerance=1e-11,
        max_iterations=30,
    )
    kinetic = column(results, "kinetic energy")
    assert np.ptp(column(results, "energy balance")) <= 1e-10 * kinetic.max()
    for name in ("momentum x", "momentum y", "angular momentum"):
        assert np.ptp(column(results, name)) <= 1e-10 * kinetic.max()
    assert np.ptp(kinetic) > 1e-5 * kinetic.max()


@pytest.mark.parametrize(
    ("kind", "scheme"),
    quickly(
        [*(("rigid", scheme) for scheme in SCHEMES), ("distributing", "hht")],
        ("rigid", "newmark"),
        ("rigid", "energy_momentum"),
        ("distributing", "hht"),
    ),
)
def test_scheme_is_of_second_order_with_constraints(kind, scheme):
    # A load that comes and goes smoothly: no increment meets an unresolved mode.
    time = np.linspace(0.0, 1.0, 2001)
    keys = {"period": 1.0, "scheme": scheme, "tolerance": 1e-10}

    def end(n):
        model = flying(kind, "Q4I")
        model.sections[0].material = ct.Elastic(E=1e4, nu=0.3, rho=1.0)
        model.velocities.clear()
        model.fix("left")
        model.amplitudes["wave"] = ct.Amplitude(time, np.sin(np.pi * time) ** 4)
        model.gravity(y=-100.0, amplitude="wave")
        return run(model, increments=n, **keys).frames[-1].U

    coarse, middle, fine = end(25), end(50), end(100)
    order = np.log2(np.abs(coarse - middle).max() / np.abs(middle - fine).max())
    assert order >= 1.85


@pytest.mark.parametrize("scheme", SCHEMES)
def test_block_slides_down_an_incline_in_axes(scheme):
    angle = 0.5
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1))
    model.section("all", element="Q4I", material=ct.Elastic(E=1e5, nu=0.0, rho=1.0))
    nodes = np.arange(model.mesh.n_nodes)
    model.local_axes(nodes, angle=-angle)
    model.fix(nodes, x=None)
    model.gravity(y=-GRAVITY)
    frame = run(model, period=1.0, increments=20, scheme=scheme).frames[-1]
    way = 0.5 * GRAVITY * np.sin(angle)
    exact = way * np.array([np.cos(angle), -np.sin(angle)])
    assert np.abs(frame.U - exact).max() <= 1e-6 * way


def test_frequencies_of_a_beam_with_a_rigid_end():
    # Cantilever of length L with a mass m at the end of a rigid link: the static flexibility
    # gives the frequencies of the two dofs of the end, for a massless beam.
    length, E, link, mass = 10.0, 1e4, 2.0, 3.0
    model = ct.Model(
        with_nodes(ct.mesh.rectangle(length, 1.0, nx=40, ny=2, cell="quad8"), (length + link, 0.5))
    )
    model.section("all", element="Q8", material=ct.Elastic(E=E, nu=0.0, rho=1e-6))
    end = model.mesh.n_nodes - 1
    model.fix("left")
    model.rigid("right", end)
    model.point_mass([end], mass)
    found = ct.solve(model, ct.Frequency(modes=2), threads=1).modes[-1].factors
    bending, shear = E / 12.0, E / 2.0 * 5.0 / 6.0
    flexible = (length**3 / 3.0 + link * length**2 + link**2 * length) / bending + length / shear
    assert found[0] == pytest.approx(1.0 / np.sqrt(flexible * mass) / (2.0 * np.pi), rel=2e-3)
    assert found[1] == pytest.approx(np.sqrt(E / length / mass) / (2.0 * np.pi), rel=2e-3)


def test_dense_and_iterative_frequencies_agree_with_constraints():
    from corota.analysis.linear import eigen

    kept = eigen.DENSE
    found = []
    try:
        for size in (10**6, 0):
            eigen.DENSE = size
            model = flying("chain", "Q4D")
            model.fix("left", rotation=True)
            found.append(ct.solve(model, ct.Frequency(modes=4), threads=1).modes[-1])
    finally:
        eigen.DENSE = kept
    assert found[0].factors == pytest.approx(found[1].factors, rel=1e-9)


def test_velocities_that_break_a_constraint_are_refused():
    model = flying("rigid", "Q4I")
    model.velocity("right", y=3.0)
    with pytest.raises(ModelError, match="breaks the constraint"):
        run(model, period=1.0, increments=2)
