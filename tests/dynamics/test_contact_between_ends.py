"""Contact of an increment acts between its ends: energy and momenta to rounding, second order.

Sources of the expected values: conservation of energy, linear and angular momentum in free flight;
the oscillator ``m y'' = -K A y`` of a stiff block on a soft layer; numerical quadrature of a law.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.integrate

import corota as ct
from corota import _core
from support.models import cell
from support.pairs import quickly

LAWS = {
    "hard": None,
    "linear": ct.PressureLaw("linear", 400.0),
    "exponential": ct.PressureLaw("exponential", 2.0, 0.02),
    "tabular": ct.PressureLaw("tabular", [0.0, 4.0, 20.0], [-0.01, 0.01, 0.04]),
}
HITS = [
    ("Q4I", "mortar", 0.3, "hard"),
    ("Q4I", "node_to_segment", 0.0, "hard"),
    ("Q8", "mortar", 0.0, "hard"),
    ("Q8", "node_to_segment", 0.3, "hard"),
    ("OPT", "mortar", 0.0, "hard"),
    ("Q4D", "node_to_segment", 0.3, "hard"),
    ("Q4I", "mortar", 0.0, "linear"),
    ("Q4I", "node_to_segment", 0.2, "exponential"),
    ("T6", "mortar", 0.2, "tabular"),
]


@pytest.mark.parametrize(("element", "method", "friction", "law"), quickly(HITS, *HITS[::3]))
def test_oblique_collision_in_free_flight(
    element: str, method: Any, friction: float, law: str
) -> None:
    """Two deformable bodies, one turned and spinning; without support nothing may be lost."""
    kind = cell(element)
    upper = ct.mesh.rectangle(1.0, 0.6, nx=3, ny=2, cell=kind)
    s, c = math.sin(0.4), math.cos(0.4)
    turned = upper.points @ np.array([[c, s], [-s, c]]) + (0.3, 0.75)
    lower = ct.mesh.rectangle(2.0, 0.5, nx=6, ny=2, cell=kind)
    model = ct.Model(ct.mesh.assembly(a=replace(upper, points=turned), b=lower))
    model.section("all", element=element, material=ct.Elastic(E=500.0, nu=0.3, rho=1.0))
    model.contact("a.bottom", "b.top", friction=friction, method=method, law=LAWS[law], name="hit")
    hits = np.arange(len(upper.points))
    model.velocity(hits, x=0.8, y=-2.0, spin=-1.0, about=(0.7, 1.2))
    step = ct.Dynamic(period=0.3, increments=50, scheme="energy_momentum", tolerance=1e-11)
    frames = ct.solve(model, step, fields=False).frames
    assert max(f.scalars["hit: force y"] for f in frames[1:]) > 1.0
    for name in ("ETOTAL", "momentum x", "momentum y", "angular momentum"):
        values = np.array([f.scalars[name] for f in frames[1:]])
        assert np.ptp(values) <= 1e-10 * np.abs(values).max(), name
    rubbed = frames[-1].scalars["ALLFD"]
    assert rubbed > 1e-3 if friction else rubbed == 0.0


@pytest.mark.parametrize("curve", ["floor", "hump"])
def test_impulse_of_a_fixed_curve(curve: str) -> None:
    """A smooth floor takes no momentum along, a smooth disc none about its center."""
    mesh = ct.mesh.rectangle(1.0, 0.4, nx=4, ny=2)
    s, c = math.sin(0.2), math.cos(0.2)
    mesh = replace(mesh, points=mesh.points @ np.array([[c, s], [-s, c]]) + (0.0, 0.02))
    model = ct.Model(mesh)
    model.section("all", element="Q4I", material=ct.Elastic(E=500.0, nu=0.3, rho=1.0))
    if curve == "floor":
        rigid = ct.RigidCurve.line((-5.0, 0.0), (5.0, 0.0))
    else:
        # Angular momentum is that about the origin, which must be the center. Mortar integrals know
        # where a long arc is cut into pieces, to 1e-9.
        model = ct.Model(replace(mesh, points=np.add(mesh.points, [-0.2, 2.0])))
        model.section("all", element="Q4I", material=ct.Elastic(E=500.0, nu=0.3, rho=1.0))
        rigid = ct.RigidCurve.arc((0.0, 0.0), 2.0, 150.0, -120.0)
    method: Any = "mortar" if curve == "floor" else "node_to_segment"
    model.contact("bottom", rigid, method=method, name="floor")
    model.velocity(x=0.5, y=-1.0)
    step = ct.Dynamic(period=0.3, increments=40, scheme="energy_momentum", tolerance=1e-11)
    frames = ct.solve(model, step, fields=False).frames[1:]
    assert max(f.scalars["floor: force y"] for f in frames) > 1.0
    kept = "momentum x" if curve == "floor" else "angular momentum"
    for name in ("ETOTAL", kept):
        values = np.array([f.scalars[name] for f in frames])
        assert np.ptp(values) <= 1e-10 * np.abs(values).max(), name


@pytest.mark.parametrize("scheme", ["newmark", "hht", "generalized_alpha", "energy_momentum"])
def test_pressure_law_is_of_second_order(scheme: str) -> None:
    """A stiff block dips into a soft layer: half the increment, a quarter of the error."""
    soft, width, height, speed = 300.0, 2.0, 0.5, 1.0
    rate = math.sqrt(soft * width / (width * height))
    end = 1.2 / rate
    exact = -speed / rate * math.sin(rate * end)
    errors = []
    for n in (12, 24):
        model = ct.Model(ct.mesh.rectangle(width, height, nx=2, ny=2))
        model.section("all", element="Q4I", material=ct.Elastic(E=1e8, nu=0.0, rho=1.0))
        floor = ct.RigidCurve.line((-9.0, 0.0), (9.0, 0.0))
        model.contact("bottom", floor, law=ct.PressureLaw("linear", soft))
        model.velocity(y=-speed)
        last = ct.solve(model, ct.Dynamic(period=end, increments=n, scheme=scheme)).frames[-1]
        errors.append(abs(last.U[:, 1].mean() - exact))
        assert errors[-1] <= 0.3 * abs(exact) / n**2 * 12
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize("law", ["linear", "exponential", "tabular"])
def test_mean_of_a_pressure_law(law: str) -> None:
    """Integral over the overclosure by quadrature; slope by differences."""
    found = LAWS[law]
    assert found is not None

    def at(gap: np.ndarray) -> tuple[np.ndarray, ...]:
        begun = -gap > found.start
        return tuple(
            np.where(begun, part, 0.0) for part in found(np.where(begun, -gap, found.start))
        )

    begin = np.array([0.05, -0.02, -0.005, 0.05, -0.03, -0.03])
    end = np.array([-0.03, 0.04, -0.0050001, 0.06, -0.03, -0.005])
    core = _core.ContactLaw(*found.constants)
    mean, slope = core.mean(begin, end)
    small = 1e-7
    rise = core.mean(begin, end - small)[0] - core.mean(begin, end + small)[0]
    for k, (a, b) in enumerate(zip(begin, end, strict=True)):
        exact = float(at(np.array([a]))[0][0])
        if a != b:
            kinks = [0.01, 0.0, -0.01, -found.start]
            inner = [x for x in kinks if min(a, b) < x < max(a, b)]
            exact = scipy.integrate.quad(
                lambda g: float(at(np.array([g]))[0][0]), a, b, points=inner or None
            )[0] / (b - a)
        assert mean[k] == pytest.approx(exact, rel=1e-9, abs=1e-12)
        assert slope[k] == pytest.approx(rise[k] / (2.0 * small), rel=1e-3, abs=1e-3)
