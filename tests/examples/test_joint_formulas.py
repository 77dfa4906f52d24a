"""Formulas of docs/howto/joints, derived without the program: elastica, beams, torsion."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, fsolve


def leaf(curvature, push, lift, start=0.0):
    """End x, y and angle of an elastica of length 1 and E I = 1 from its clamp at `start`.

    theta'' = push sin(theta) - lift cos(theta) for the constant force (push, lift) along x and y.
    """

    def rate(_, z):
        theta, kappa = z[2], z[3]
        slope = push * np.sin(theta) - lift * np.cos(theta)
        return [np.cos(theta), np.sin(theta), kappa, slope]

    found = solve_ivp(rate, (0, 1), [0, 0, start, curvature], rtol=1e-11, atol=1e-13)
    return found.y[:, -1]


@pytest.mark.parametrize(("force", "travel"), [(1.0, 0.30172), (3.0, 0.60325)])
def test_bisshopp_and_drucker(force, travel):
    curvature = brentq(lambda k: leaf(k, 0.0, force)[3], 0.0, 3.0)
    assert leaf(curvature, 0.0, force)[1] == pytest.approx(travel, abs=6e-6)


@pytest.mark.parametrize(
    ("degrees", "moment", "shift"),
    [
        (10.0, 0.350829, None),
        (20.0, 0.712016, (-2.466104e-3, 1.398597e-2)),
        (30.0, 1.092898, None),
        (40.0, 1.501060, (-1.881520e-2, 5.169433e-2)),
    ],
)
def test_cross_spring_pivot(degrees, moment, shift):
    """Both leaves end on the hub, whose forces are in balance, by shooting."""
    turn, half = np.radians(degrees), np.sqrt(0.125)
    starts = [np.array([-half, -half]), np.array([half, -half])]
    angles = [0.25 * np.pi, 0.75 * np.pi]
    c, s = np.cos(turn), np.sin(turn)
    spin = np.array([[c, -s], [s, c]])

    def ends(z):
        return [leaf(*z[3 * k : 3 * k + 3], start=angles[k]) for k in range(2)]

    def residual(z):
        move, total = z[6:8], []
        for start, angle, end in zip(starts, angles, ends(z), strict=True):
            wanted = spin @ -start + move
            total += [*(start + end[:2] - wanted), end[2] - angle - turn]
        return [*total, z[1] + z[4], z[2] + z[5]]

    found = fsolve(residual, [turn, 0, 0, turn, 0, 0, 0, 0], xtol=1e-12)
    balance = 0.0
    for k, end in enumerate(ends(found)):
        # Force and moment of the leaf's end on the hub are minus those on the leaf.
        arm = spin @ -starts[k]
        push, lift = found[3 * k + 1 : 3 * k + 3]
        balance += end[3] + arm[0] * lift - arm[1] * push
    assert balance == pytest.approx(moment, rel=2e-6)
    if shift:
        assert found[6:8] == pytest.approx(shift, rel=2e-5)


def test_thin_notch():
    """The integral along h = t + x^2 / R is 9 pi R^.5 / (2 E b t^2.5)."""
    radius, neck = 5.0, 1.0
    flexibility = quad(lambda x: 12.0 / (neck + x * x / radius) ** 3, -np.inf, np.inf)[0]
    assert 1.0 / flexibility == pytest.approx(2.0 * neck**2.5 / (9.0 * np.pi * radius**0.5))


def test_shortening_of_a_guided_leaf():
    assert 0.5 * quad(lambda s: (6.0 * s - 6.0 * s * s) ** 2, 0, 1)[0] == pytest.approx(0.6)


@pytest.mark.parametrize(("travel", "published"), [(0.16, 740.0), (1.92, -370.0)])
def test_cosine_beam_between_its_corners(travel, published):
    """y'' + 16 pi^2 y = y0'' + F x / 2 on half of the beam: F = 64 pi^2 (4 / 3 - travel).

    The slope vanishes in the middle for each F, because 16 pi^2 belongs to the third mode.
    """

    def middle(force):
        def rate(x, z):
            given = 2.0 * np.pi**2 * np.cos(2.0 * np.pi * x)
            return [z[1], given - 16.0 * np.pi**2 * z[0] + 0.5 * force * x]

        return solve_ivp(rate, (0.0, 0.5), [0.0, 0.0], rtol=1e-11, atol=1e-13).y[:, -1]

    force = brentq(lambda f: middle(f)[0] - (1.0 - travel), -2000.0, 2000.0)
    assert middle(force)[1] == pytest.approx(0.0, abs=1e-6)
    assert force == pytest.approx(64.0 * np.pi**2 * (4.0 / 3.0 - travel), rel=1e-6)
    assert force == pytest.approx(published, rel=2e-3)


def test_v_beam():
    """Stiffness matrix of one inclined beam whose far end moves along y only."""
    length, slope, thick, young = 100.0, np.radians(4.0), 2.0, 1.6e5
    c, s = np.cos(slope), np.sin(slope)
    axial, across = young * thick / length, 12.0 * young * thick**3 / 12.0 / length**3
    turn = np.array([[c, -s], [s, c]])
    matrix = turn @ np.diag([axial, across]) @ turn.T
    strain = 1e-5
    thermal = young * thick * strain * np.array([c, s])
    formula = strain * length * s / (s * s + c * c * thick**2 / length**2)
    assert thermal[1] / matrix[1, 1] == pytest.approx(formula)


def test_torsion_constant_of_a_rectangle():
    """Series of Saint-Venant for 2 x 1; the formula is 0.09 % above it."""
    a, b = 2.0, 1.0
    terms = sum(np.tanh(n * np.pi * a / (2.0 * b)) / n**5 for n in range(1, 60, 2))
    exact = a * b**3 * (1.0 / 3.0 - 64.0 / np.pi**5 * b / a * terms)
    p, q = 0.5 * a, 0.5 * b
    roark = p * q**3 * (16.0 / 3.0 - 3.36 * q / p * (1.0 - q**4 / (12.0 * p**4)))
    assert exact == pytest.approx(0.457363, abs=2e-6)
    assert roark / exact == pytest.approx(1.0009, abs=1e-4)
