"""Gradients beside derivatives of closed forms."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import corota as ct
from corota import gradients
from corota.verification.beam_models import polyline


def lame(p: float, a: float, b: float) -> float:
    """Displacement of the bore of a ring under pressure in plane stress, E = 1000, nu = 0.3."""
    return p * a / 1000.0 * ((a**2 + b**2) / (b**2 - a**2) + 0.3)


def ring(x: np.ndarray) -> ct.Model:
    p, a, b = x
    model = ct.Model(ct.mesh.annulus(a, b, 8, 8, angle=90.0, cell="quad9"))
    model.section("all", element="Q9", material=ct.Elastic(E=1000.0, nu=0.3))
    model.fix("start", x=None)
    model.fix("end", y=None)
    model.pressure("inner", p)
    model.steps = [ct.Static(nlgeom=False)]
    return model


def test_lame_by_pressure_and_radii() -> None:
    x = np.array([1.0, 1.0, 2.0])
    bore = int(np.argmin(np.hypot(*(ring(x).mesh.points - (x[1], 0.0)).T)))
    value, found = ct.value_and_grad(ring, gradients.Displacement(bore, "x"), threads=1)(x)
    step = 1e-5
    exact = [(lame(*(x + step * e)) - lame(*(x - step * e))) / (2.0 * step) for e in np.eye(3)]
    assert value == pytest.approx(lame(*x), rel=1e-5)
    np.testing.assert_allclose(found, exact, rtol=3e-5)


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


def toggle(x: np.ndarray) -> ct.Model:
    """Half of Williams' toggle with a given rise."""
    way = np.linspace(0.0, 1.0, 31)
    model = ct.Model(polyline(np.stack([12.943 * way, x[0] * way], axis=1)))
    area, inertia = 0.753 * 0.243, 0.753 * 0.243**3 / 12.0
    model.beam(np.arange(30), material=ct.Elastic(E=1.03e7), area=area, inertia=inertia)
    model.fix([0], rotation=True)
    model.fix([30], y=None, rotation=True)
    model.force([30], y=-10.0)
    model.steps = [ct.Static(path=ct.ArcLength(displacement=([30], "y", -0.7)))]
    return model


def test_limit_load_of_the_toggle_over_its_rise() -> None:
    """The gradient is that of the limit loads of other rises."""
    limit = ct.value_and_grad(toggle, gradients.LimitLoad(), threads=1)
    _, slope = limit([0.386])
    ahead, behind = (limit([0.386 + h])[0] for h in (1e-3, -1e-3))
    more, less = (limit([0.386 + h])[0] for h in (2e-3, -2e-3))
    difference = (8.0 * (ahead - behind) - (more - less)) / 12e-3
    assert slope[0] == pytest.approx(difference, rel=1e-8)


def column(x: np.ndarray) -> ct.Model:
    height, width = x
    model = ct.Model(ct.mesh.rectangle(40.0, height, nx=20, ny=1, cell="quad9"))
    model.section("all", element="Q9", material=ct.Elastic(E=1e4, nu=0.0), thickness=width)
    model.fix("left")
    model.force("right", x=-1.0)
    euler = math.pi**2 * 1e4 * width * height**3 / 12.0 / 80.0**2
    model.steps = [ct.Static(path=ct.ArcLength(factor=1.3 * euler))]
    return model


def test_euler_load_over_both_thicknesses() -> None:
    """Three times the load over the thickness in the plane, less what shear and shortening take."""
    value, slope = ct.value_and_grad(column, gradients.BifurcationLoad(), threads=1)([1.0, 2.0])
    exact = math.pi**2 * 1e4 * 2.0 / 12.0 / 80.0**2
    assert value == pytest.approx(exact, rel=2e-3)
    assert slope[0] / value == pytest.approx(3.0, rel=2e-3)
    assert slope[1] * 2.0 / value == pytest.approx(1.0, rel=1e-6)


def cantilever(x: np.ndarray) -> ct.Model:
    way = np.linspace(0.0, 1.0, 65)
    model = ct.Model(polyline(np.stack([way, 0.0 * way], axis=1)))
    model.beam(np.arange(64), material=ct.Elastic(E=1.0), area=1e8, inertia=1.0)
    model.fix([0], rotation=True)
    model.force([64], y=x[0])
    return model


def elastica(load: float) -> float:
    """Deflection of the tip of an inextensible cantilever, L = EI = 1, under a dead load."""

    def end(first: float) -> np.ndarray:
        found = solve_ivp(
            lambda _, y: [y[1], -load * math.cos(y[0]), math.cos(y[0]), math.sin(y[0])],
            (0.0, 1.0),
            [0.0, first, 0.0, 0.0],
            rtol=1e-12,
            atol=1e-13,
        )
        return np.asarray(found.y[:, -1])

    first = brentq(lambda k: end(k)[1], 0.0, load, xtol=1e-14)
    return float(end(first)[3])


def test_tip_of_the_elastica_over_its_load() -> None:
    """At a load of 4 EI / L^2 the tip has moved by .6700 L (Bisshopp & Drucker 1945)."""
    value, slope = ct.value_and_grad(cantilever, gradients.Displacement(64, "y"), threads=1)([4.0])
    exact = (elastica(4.001) - elastica(3.999)) / 0.002
    assert value == pytest.approx(0.6700, abs=2e-4)
    assert slope[0] == pytest.approx(exact, rel=1e-3)
