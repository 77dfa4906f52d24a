"""Particles and springs in large motion beside integrations by SciPy."""

# SPDX-License-Identifier: BSD-3-Clause
import math

import numpy as np
import pytest

import corota as ct
from support.pairs import quickly
from support.particles import (
    IMPLICIT,
    bars,
    extrapolated,
    integrate,
    network,
    table,
)

pytestmark = pytest.mark.filterwarnings("ignore:central differences took")


@pytest.mark.parametrize(
    "scheme",
    quickly([*IMPLICIT, "central_difference"], "hht", "energy_momentum", "central_difference"),
)
def test_spring_pendulum_that_loops(scheme):
    # Newton's law of a particle on a linear spring, EA/L = 50, that goes round with a slack
    # spring in between; SciPy DOP853.
    k, length, m, g = 50.0, 1.0, 2.0, 9.81

    def rate(_, z):
        r = np.hypot(z[0], z[1])
        return [z[2], z[3], *(-k * (r - length) * z[:2] / r / m + np.array([0.0, -g]))]

    exact = integrate(rate, [0.0, -length, 9.0, 0.0], 2.0)

    def run(n):
        model = network([[0.0, 0.0], [0.0, -length]], [[0, 1]])
        bars(model, [0], k, length)
        model.point_mass([1], m)
        model.fix([0])
        model.force([1], y=-m * g)
        model.velocity([1], x=9.0)
        step = ct.Dynamic(period=2.0, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        reaction = frame.RF[0, :2]
        return np.r_[frame.U[1] + [0.0, -length], frame.V[1, :2], reaction]

    found = extrapolated(run, 120)
    np.testing.assert_allclose(found[:4], exact, rtol=0, atol=2e-4)
    r = np.hypot(*exact[:2])
    np.testing.assert_allclose(found[4:], -k * (r - length) * exact[:2] / r, rtol=0, atol=2e-2)


@pytest.mark.parametrize("scheme", IMPLICIT)
def test_pendulum_on_a_support_moved_by_a_table_with_corners(scheme):
    # The support moves by straight pieces, the first of which starts with a jump of velocity; the
    # particle feels the spring alone, so the corners need no pulse in the reference.
    k, length, m, g = 200.0, 0.8, 1.5, 9.81
    t, x, y = [0.0, 0.3, 0.6, 1.2], [0.0, 0.15, 0.15, -0.3], [0.0, 0.0, 0.2, 0.1]

    def rate(now, z):
        d = z[:2] - [np.interp(now, t, x), np.interp(now, t, y)]
        r = np.hypot(*d)
        return [z[2], z[3], *(-k * (r - length) * d / r / m + np.array([0.0, -g]))]

    exact = integrate(rate, [0.0, -length, 0.0, 0.0], 1.2, t)

    def run(n):
        model = network([[0.0, 0.0], [0.0, -length]], [[0, 1]])
        bars(model, [0], k, length)
        model.point_mass([1], m)
        table(model, "x", t, x)
        table(model, "y", t, y)
        model.fix([0], x=1.0, y=None, amplitude="x")
        model.fix([0], x=None, y=1.0, amplitude="y")
        model.force([1], y=-m * g)
        step = ct.Dynamic(period=1.2, increments=n, scheme=scheme)
        frame = ct.solve(model, step, fields=False).frames[-1]
        return np.r_[frame.U[1] + [0.0, -length], frame.V[1, :2]]

    np.testing.assert_allclose(extrapolated(run, 120), exact, rtol=0, atol=1e-3)


@pytest.mark.parametrize("scheme", [*IMPLICIT, "central_difference"])
def test_support_that_starts_with_a_jump_of_velocity(scheme):
    # m x'' = k (v t - x): x = v t - v/w sin wt. The force of the support is k (v t - x), without
    # mass there; its work is v times the impulse of that force, m v x'.
    k, m, v = 30.0, 2.0, 0.7
    w, end = math.sqrt(k / m), 1.7

    def run(n):
        model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
        bars(model, [0], k, 1.0)
        model.point_mass([1], m)
        table(model, "move", [0.0, 10.0], [0.0, 10.0])
        model.fix([0], x=v, y=0.0, amplitude="move")
        model.fix([1], x=None)
        step = ct.Dynamic(period=end, increments=n, scheme=scheme)
        frame = ct.solve(model, step).frames[-1]
        return np.r_[frame.U[1, 0], frame.V[1, 0], frame.RF[0, 0], frame.scalars["ALLWK"]]

    rate = v - v * math.cos(w * end)
    force = k * v / w * math.sin(w * end)
    exact = [v * end - v / w * math.sin(w * end), rate, force, m * v * rate]
    np.testing.assert_allclose(extrapolated(run, 100), exact, rtol=0, atol=2e-3)


@pytest.mark.parametrize("scheme", quickly(IMPLICIT, "generalized_alpha", "energy_momentum"))
def test_spinning_spring_with_a_dashpot_in_line(scheme):
    # Two particles joined by a spring and a dashpot fly and spin: the dashpot acts on the rate of
    # the length alone. Its dissipation is the integral of c (dr/dt)^2.
    k, length, c, m1, m2 = 40.0, 1.0, 3.0, 1.0, 2.0

    def rate(_, z):
        d, v = z[2:4] - z[:2], z[6:8] - z[4:6]
        r = np.hypot(*d)
        e = d / r
        pull = (k * (r - length) + c * (v @ e)) * e
        return np.r_[z[4:8], pull / m1, -pull / m2, c * (v @ e) ** 2]

    spin, drift = 4.0, np.array([0.5, -1.0])
    start = [0.0, 0.0, 1.0, 0.0, *drift, drift[0], drift[1] + spin, 0.0]
    exact = integrate(rate, start, 2.5)

    def run(n):
        model = network([[0.0, 0.0], [1.0, 0.0]], [[0, 1]])
        bars(model, [0], k, length)
        model.point_mass([0], m1)
        model.point_mass([1], m2)
        model.dashpot(0, 1, c=c)
        model.velocity(x=drift[0], y=drift[1], spin=spin)
        frame = ct.solve(model, ct.Dynamic(period=2.5, increments=n, scheme=scheme)).frames[-1]
        place = np.add(frame.U, [[0.0, 0.0], [1.0, 0.0]]).ravel()
        return np.r_[place, frame.V[:, :2].ravel(), frame.scalars["ALLVD"]]

    np.testing.assert_allclose(extrapolated(run, 80), exact, rtol=0, atol=2e-3)


@pytest.mark.parametrize("scheme", ["newmark", "energy_momentum", "central_difference"])
def test_hanging_chain_of_three_particles(scheme):
    # A chain of three springs thrown sideways; Newton's laws by SciPy.
    k, m, g = np.array([300.0, 200.0, 150.0]), np.array([1.0, 0.5, 0.8]), 9.81
    base = np.array([[0.0, 0.0], [0.6, 0.0], [1.2, 0.0], [1.8, 0.0]])

    def rate(_, z):
        x = np.vstack([[0.0, 0.0], z[:6].reshape(3, 2)])
        d = np.diff(x, axis=0)
        r = np.linalg.norm(d, axis=1)
        pull = (k * (r - 0.6) / r)[:, None] * d
        force = -pull + np.vstack([pull[1:], [[0.0, 0.0]]])
        return np.r_[z[6:], (force / m[:, None] + [0.0, -g]).ravel()]

    start = np.r_[base[1:].ravel(), np.zeros(6)]
    exact = integrate(rate, start, 0.6)[:6].reshape(3, 2)

    def run(n):
        model = network(base, [[0, 1], [1, 2], [2, 3]])
        for i in range(3):
            bars(model, [i], k[i], 0.6)
            model.point_mass([i + 1], m[i])
            model.force([i + 1], y=-m[i] * g)
        model.fix([0])
        step = ct.Dynamic(period=0.6, increments=n, scheme=scheme)
        return ct.solve(model, step, fields=False).frames[-1].U[1:] + base[1:]

    np.testing.assert_allclose(extrapolated(run, 80), exact, rtol=0, atol=2e-4)
