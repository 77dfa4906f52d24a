"""Disc springs: friction of the edges beside statics, the snap beside Almen and Laszlo."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest


@pytest.mark.parametrize("method", ["mortar", "node_to_segment"])
def test_friction_of_the_edges_acts_with_their_distance_as_its_arm(load, method: str) -> None:
    example = load("disc_spring/disc_spring.py")
    free = example.press_and_release(0.0, method)
    rough = example.press_and_release(0.1, method)
    for (s, force), (_, other), down in zip(free, rough, (True, False), strict=True):
        assert other / force == pytest.approx(example.friction_ratio(s, 0.1, down), abs=5e-4)
        # The formula with E in place of E / (1 - nu^2).
        assert force == pytest.approx(0.91 * example.formula(s, 1.6, 1.25), rel=0.04)


def test_the_steep_spring_snaps_through_and_back(load) -> None:
    """Maximum and minimum as critical points, unstable between them, work equal to energy."""
    example = load("disc_spring/disc_spring.py")
    results, upper = example.snap()
    high, low = results.critical_points
    assert (high.kind, low.kind) == ("limit", "limit")
    s = np.linspace(0.0, 4.6, 2000)
    curve = np.array([0.91 * example.formula(v, 2.2, 1.0) for v in s])
    top = int(curve[:1000].argmax())
    bottom = top + int(curve[top:].argmin())
    assert 1000.0 * high.factor == pytest.approx(curve[top], rel=0.02)
    assert 1000.0 * low.factor == pytest.approx(curve[bottom], rel=0.12)
    way = -results.history("U2", at=[upper]).values
    force = 1000.0 * results.history("load factor").values
    stable = results.history("stable").values[1:]
    changes = np.flatnonzero(np.diff(stable))
    assert len(changes) == 2
    assert way[1:][changes + 1] == pytest.approx([s[top], s[bottom]], rel=0.25)
    energy = results.frames[-1].scalars["strain energy"]
    assert energy == pytest.approx(np.trapezoid(force, way), rel=0.01)


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_thin_springs_agree_with_the_hoop_modulus(load, monkeypatch, nu: float) -> None:
    """A fifth of the thickness and height: E alone within half a percent, whatever nu."""
    import corota as ct

    example = load("disc_spring/disc_spring.py")
    monkeypatch.setattr(example, "NU", nu)
    mesh, upper, lower = example.disc(0.32, 0.25)
    model = ct.Model(mesh)
    model.section("all", element="Q8R", material=ct.Elastic(example.E, nu), plane="axisymmetric")
    model.fix([lower], x=None)
    step = ct.Static(increments=2)
    step.fix([upper], x=None, y=-0.16)
    force = -ct.solve(model, step, threads=1).frames[-1].RF[upper, 1]
    assert force == pytest.approx((1.0 - nu**2) * example.formula(0.16, 0.32, 0.25), rel=0.02)
