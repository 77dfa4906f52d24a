"""Gradients beside derivatives of closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

import corota as ct
from corota import gradients
from corota.verification.beam_models import polyline

if TYPE_CHECKING:
    from collections.abc import Callable


def extrapolated(values: list) -> np.ndarray:
    """Limit of values of meshes that are halved again and again: errors go with h^2, h^4, ..."""
    found = [np.asarray(v) for v in values]
    for k in range(1, len(found)):
        found = [(4.0**k * b - a) / (4.0**k - 1.0) for a, b in pairwise(found)]
    return found[0]


def lame(p: float, a: float, b: float) -> tuple[float, list[float]]:
    """Displacement of the bore of a ring under pressure in plane stress, E = 1000, nu = 0.3."""
    q = b**2 - a**2
    ratio = (a**2 + b**2) / q + 0.3
    slopes = [
        a * ratio,
        p * ratio + p * a * 4.0 * a * b**2 / q**2,
        -p * a * 4.0 * a**2 * b / q**2,
    ]
    return p * a * ratio / 1000.0, [v / 1000.0 for v in slopes]


def ring(x: np.ndarray) -> ct.Model:
    """A sector of two degrees."""
    p, a, b = x
    model = ct.Model(ct.mesh.annulus(a, b, 32, 1, angle=2.0, cell="quad9"))
    model.section("all", element="Q9", material=ct.Elastic(E=1000.0, nu=0.3))
    model.local_axes("end", angle=math.radians(2.0))
    model.fix("start", x=None)
    model.fix("end", x=None)
    model.pressure("inner", p)
    model.steps = [ct.Static(nlgeom=False)]
    return model


def test_lame_by_pressure_and_radii() -> None:
    x = np.array([1.0, 1.0, 2.0])
    bore = int(np.argmin(np.hypot(*(ring(x).mesh.points - (x[1], 0.0)).T)))
    value, found = ct.value_and_grad(ring, gradients.Displacement(bore, "x"), threads=1)(x)
    exact, slopes = lame(*x)
    assert value == pytest.approx(exact, rel=1e-7)
    np.testing.assert_allclose(found, slopes, rtol=1e-7)


def truss(x: np.ndarray) -> ct.Model:
    """Two bars of half span 10 with a rise; EA = 1000."""
    model = ct.Model(polyline([[0.0, 0.0], [10.0, x[0]], [20.0, 0.0]]))
    model.truss([0, 1], material=ct.Elastic(E=1000.0), area=1.0)
    model.fix([0, 2])
    model.force([1], y=-1.0)
    model.steps = [ct.Static(path=ct.ArcLength(displacement=([1], "y", -1.2 * x[0])))]
    return model


def test_limit_load_of_two_bars_over_their_rise() -> None:
    """The load 2 EA (1 - cos a / cos t) sin t is largest where cos^3 t = cos a."""

    def exact(rise: float) -> float:
        cosine = 10.0 / math.hypot(10.0, rise)
        return float(2000.0 * (1.0 - cosine ** (2.0 / 3.0)) ** 1.5)

    value, slope = ct.value_and_grad(truss, gradients.LimitLoad(), threads=1)([1.5])
    derivative = (exact(1.5 + 1e-4) - exact(1.5 - 1e-4)) / 2e-4
    assert value == pytest.approx(exact(1.5), rel=1e-12)
    assert slope[0] == pytest.approx(derivative, rel=1e-7)


def toggle(n: int) -> Callable[[np.ndarray], ct.Model]:
    """Half of Williams' toggle with a given rise, of n beams."""

    def build(x: np.ndarray) -> ct.Model:
        way = np.linspace(0.0, 1.0, n + 1)
        model = ct.Model(polyline(np.stack([12.943 * way, x[0] * way], axis=1)))
        model.beam(np.arange(n), material=ct.Elastic(E=1.03e7), area=AREA, inertia=INERTIA)
        model.fix([0], rotation=True)
        model.fix([n], y=None, rotation=True)
        model.force([n], y=-10.0)
        model.steps = [ct.Static(path=ct.ArcLength(displacement=([n], "y", -0.7)))]
        return model

    return build


AREA, INERTIA = 0.753 * 0.243, 0.753 * 0.243**3 / 12.0


def beam_theory(rise: float) -> tuple[float, float]:
    """Limit load of the toggle and its derivative by the rise: beams of any rotation that stretch.

    With the force F and the moment M of a section, N = F . t, x' = (1 + N / EA) t, t' = M / EI and
    M' = -(x' x F). The load is largest where it does not change with the displacement w; its
    derivative by the rise is that at fixed w.
    """
    axial, bending = 1.03e7 * AREA, 1.03e7 * INERTIA

    def miss(q: np.ndarray, w: float) -> tuple[np.ndarray, np.ndarray]:
        """End conditions, and their derivatives by q, w and the rise, by complex steps."""
        steps = 1e-30j * np.eye(5)
        moment, along, up = q[:, None] + steps[:3]
        moved, high = w + steps[3], rise + steps[4]
        length, angle = np.sqrt(12.943**2 + high**2), np.arctan(high / 12.943)

        def rate(y: np.ndarray) -> np.ndarray:
            c, s = np.cos(y[2]), np.sin(y[2])
            stretch = 1.0 + (along * c + up * s) / axial
            turn = stretch * (s * along - c * up)
            return np.array([stretch * c, stretch * s, y[3] / bending, turn])

        y, h = np.array([0.0 * angle, 0.0 * angle, angle, moment]), length / 100
        for _ in range(100):
            k1 = rate(y)
            k2 = rate(y + 0.5 * h * k1)
            k3 = rate(y + 0.5 * h * k2)
            y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rate(y + h * k3))
        found = np.array([y[0] - 12.943, y[1] - high + moved, y[2] - angle])
        return found[:, 0].real, found.imag / 1e-30

    state = [np.array([0.0, -1.0, -1e-3])]

    def by_displacement(w: float) -> float:
        q = state[0]
        for _ in range(20):
            residual, slopes = miss(q, w)
            step = np.linalg.solve(slopes[:, :3], residual)
            q = q - step
            if np.abs(step).max() < 1e-12 * np.abs(q).max():
                break
        state[0] = q
        return float(-np.linalg.solve(slopes[:, :3], slopes[:, 3])[2])

    for w in (0.05, 0.1, 0.15):
        by_displacement(w)
    w = brentq(by_displacement, 0.2, 0.34, xtol=1e-10)
    by_displacement(w)
    slopes = miss(state[0], w)[1]
    return float(-state[0][2]), float(np.linalg.solve(slopes[:, :3], slopes[:, 4])[2])


def test_limit_load_of_the_toggle_over_its_rise() -> None:
    """Williams' toggle beside the theory of beams."""
    runs = [
        ct.value_and_grad(toggle(n), gradients.LimitLoad(), threads=1)([0.386])
        for n in (10, 20, 40, 80)
    ]
    load, slope = beam_theory(0.386)
    value, found = (extrapolated([run[k] for run in runs]) for k in (0, 1))
    assert 10.0 * value == pytest.approx(load, rel=1e-7)
    assert 10.0 * found[0] == pytest.approx(slope, rel=1e-7)


def column(n: int, x: np.ndarray, shorten: bool = False) -> ct.Model:
    """A slender cantilever of a height and a width, pressed by a load or by a displacement."""
    height, width = x
    model = ct.Model(polyline(np.stack([np.linspace(0.0, 100.0, n + 1), np.zeros(n + 1)], axis=1)))
    area, inertia = height * width, width * height**3 / 12.0
    model.beam(np.arange(n), material=ct.Elastic(E=1e4), area=area, inertia=inertia)
    model.fix([0], rotation=True)
    if shorten:
        model.fix([n], x=-euler(HEIGHT, WIDTH)[0] * 100.0 / (1e4 * HEIGHT * WIDTH), y=None)
    else:
        model.force([n], x=-euler(HEIGHT, WIDTH)[0])
    model.steps = [ct.Static(path=ct.ArcLength(factor=1.3))]
    return model


HEIGHT, WIDTH = 1.0, 2.0


def euler(height: float, width: float) -> tuple[float, float]:
    """Load of the column, and its power of the height: Euler's, and what shortening changes.

    The bent column is shorter by P / EA: P (1 - P / EA) is Euler's load, of the power three.
    """
    axial = 1e4 * height * width
    load = math.pi**2 * axial * height**2 / 12.0 / 200.0**2
    found = 0.5 * axial * (1.0 - math.sqrt(1.0 - 4.0 * load / axial))
    power = (3.0 * load - found**2 / axial) / (1.0 - 2.0 * found / axial) / found
    return found, power


def test_euler_load_over_both_thicknesses() -> None:
    """Three times the load over the thickness in the plane, once over the other."""
    x = np.array([HEIGHT, WIDTH])
    runs = [
        ct.value_and_grad(lambda y, n=n: column(n, y), gradients.BifurcationLoad(), threads=1)(x)
        for n in (8, 16, 32)
    ]
    power = euler(*x)[1]
    assert power == pytest.approx(3.0, rel=1e-4)
    assert extrapolated([value for value, _ in runs]) == pytest.approx(1.0, rel=1e-7)
    powers = extrapolated([slope * x / value for value, slope in runs])
    np.testing.assert_allclose(powers, [power, 1.0], rtol=1e-7)


def test_euler_shortening_over_both_thicknesses() -> None:
    """The load is a prescribed displacement: it goes with the second power, and not at all."""
    x = np.array([HEIGHT, WIDTH])

    def build(y: np.ndarray) -> ct.Model:
        return column(16, y, shorten=True)

    value, slope = ct.value_and_grad(build, gradients.BifurcationLoad(), threads=1)(x)
    force, by_force = ct.value_and_grad(
        lambda y: column(16, y), gradients.BifurcationLoad(), threads=1
    )(x)
    assert value == pytest.approx(force, rel=1e-8)
    expected = by_force * x / force - 1.0
    np.testing.assert_allclose(slope * x / value, expected, rtol=1e-7, atol=1e-7)


def cantilever(n: int, load: float, stiffness: float) -> ct.Model:
    way = np.linspace(0.0, 1.0, n + 1)
    model = ct.Model(polyline(np.stack([way, 0.0 * way], axis=1)))
    model.beam(np.arange(n), material=ct.Elastic(E=1.0), area=stiffness, inertia=1.0)
    model.fix([0], rotation=True)
    model.force([n], y=load)
    return model


def elastica(load: float) -> float:
    """Deflection of the tip of an inextensible cantilever, L = EI = 1 (Bisshopp, Drucker 1945)."""
    root = math.sqrt(load)

    def rest(m: float) -> float:
        return float(ellipk(m) - ellipkinc(math.asin(math.sqrt(0.5 / m)), m) - root)

    m = brentq(rest, 0.5 + 1e-9, 1.0 - 1e-9, xtol=1e-16, rtol=1e-15)
    start = math.asin(math.sqrt(0.5 / m))
    return float(1.0 - 2.0 / root * (ellipe(m) - ellipeinc(start, m)))


def test_tip_of_the_elastica_over_its_load() -> None:
    """At a load of 4 EI / L^2 the tip has moved by .6700 L."""
    bars = []
    for stiffness in (1e6, 2e6):
        runs = [
            ct.value_and_grad(
                lambda x, n=n, a=stiffness: cantilever(n, x[0], a),
                gradients.Displacement(n, "y"),
                threads=1,
            )([4.0])
            for n in (16, 32, 64, 128)
        ]
        bars.append([float(extrapolated([np.ravel(run[k])[0] for run in runs])) for k in (0, 1)])
    value, slope = 2.0 * np.array(bars[1]) - bars[0]  # bars that do not stretch
    h = 1e-2
    near, far = (elastica(4.0 + k * h) - elastica(4.0 - k * h) for k in (1, 2))
    farther = elastica(4.0 + 3.0 * h) - elastica(4.0 - 3.0 * h)
    exact = (45.0 * near - 9.0 * far + farther) / (60.0 * h)
    assert elastica(4.0) == pytest.approx(0.6700, abs=1e-4)
    assert value == pytest.approx(elastica(4.0), rel=1e-7)
    assert slope == pytest.approx(exact, rel=1e-7)
