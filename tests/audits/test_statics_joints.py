"""Ties and contact of unlike meshes, thicknesses and temperatures, against answers found apart."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import corota as ct
from corota.model.loads import Fixed, Temperature
from support.audits import CELL, DRILLING, rotation

pytestmark = pytest.mark.filterwarnings("ignore:local strain reaches")


@pytest.mark.parametrize("pair", [("CPE8", "quad8"), ("T6", "tri6"), ("Q4I", "quad4")])
@pytest.mark.parametrize("angle", [0.0, 120.0])
def test_tied_halves_of_unlike_meshes_and_thickness(pair: tuple[str, str], angle: float) -> None:
    """Tension across a tie, thickness 1 and 2, nu = 0: the force passes, stress halves.

    Turned by 120 degrees through supports in turned axes.
    """
    name, cell = pair
    element = {"CPE8": "Q8"}.get(name, name)
    low = ct.mesh.rectangle(2.0, 1.0, nx=3, ny=2, cell=cell)
    high = ct.mesh.rectangle(2.0, 1.0, nx=4, ny=2, cell=cell, origin=(0.0, 1.0))
    mesh = ct.mesh.move(ct.mesh.assembly(low=low, high=high), angle=angle)
    model = ct.Model(mesh)
    material = ct.Elastic(E=100.0, nu=0.0)
    model.section("low", element=element, material=material, thickness=1.0)
    model.section("high", element=element, material=material, thickness=2.0)
    model.tie("high.bottom", "low.top")
    a = math.radians(angle)
    for s in ("low.bottom", "high.top"):
        model.local_axes(s, angle=a)
    model.fix("low.bottom", x=None)
    model.fix([int(mesh.nodes_of("low.bottom")[0])])
    model.fix("high.top", x=None, y=0.03)
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    # Springs in series: 100 * 2 * (1 | 2) / 1
    force = 0.03 / (1 / 200.0 + 1 / 400.0)
    n = rotation(a)[:, 1]
    assert n @ frame.RF[mesh.nodes_of("high.top"), :2].sum(axis=0) == pytest.approx(force, rel=1e-8)
    for k, stress in ((0, force / 2.0), (1, force / 4.0)):
        S = frame.fields[k].values["S"]
        assert np.allclose(S[..., 0], stress * n[0] ** 2, atol=1e-7)
        assert np.allclose(S[..., 3], stress * n[0] * n[1], atol=1e-7)


def test_contact_of_two_thicknesses(tmp_path: Path) -> None:
    """Two blocks pressed together: CF sums to the force, CPRESS is force over the smaller area.

    The supports carry the same; a straight interface, nu = 0.
    """
    low = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1)
    high = ct.mesh.rectangle(2.0, 1.0, nx=3, ny=1, origin=(0.0, 1.0))
    mesh = ct.mesh.assembly(low=low, high=high)
    for thin in ("low", "high"):
        model = ct.Model(mesh)
        for body in ("low", "high"):
            model.section(
                body,
                element="Q4I",
                material=ct.Elastic(E=100.0, nu=0.0),
                thickness=1.0 if body == thin else 3.0,
            )
        model.contact("high.bottom", "low.top", name="joint")
        model.fix("low.bottom")
        model.fix("high.top", y=-0.03)
        model.fix("high", x=0.0, y=None)
        results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
        force = 0.03 / (1 / 200.0 + 1 / 600.0)
        slave = mesh.nodes_of("high.bottom")
        assert np.allclose(results.nodal("CPRESS")[slave], force / 2.0, rtol=1e-7)
        assert results.history("joint: force y")[-1] == pytest.approx(force, rel=1e-7)
        assert results.frames[-1].RF[mesh.nodes_of("low.bottom"), 1].sum() == pytest.approx(
            force, rel=1e-7
        )


@pytest.mark.parametrize("element", ["Q4I", "Q8", "T6", "Q4D"])
def test_tied_body_turned_far_then_heated(element: str) -> None:
    """Two tied blocks turned by 150 degrees stay without stress; heat in one then acts as at rest.

    The stresses of the heated, turned body are those of the body that was never turned, turned.
    """
    stresses = []
    for angle in (0.0, 150.0):
        cell = CELL[element]
        low = ct.mesh.rectangle(2.0, 1.0, nx=3, ny=2, cell=cell)
        high = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=2, cell=cell, origin=(0.0, 1.0))
        mesh = ct.mesh.assembly(low=low, high=high)
        model = ct.Model(mesh)
        elastic = ct.Elastic(E=100.0, nu=0.3, expansion=1e-3)
        model.section("low", element=element, material=elastic, local_strain="green_lagrange")
        model.section("high", element=element, material=elastic, local_strain="green_lagrange")
        model.tie("high.bottom", "low.top")
        bottom = mesh.nodes_of("low.bottom")
        steps = []
        a = math.radians(angle)
        for turn in np.linspace(0.0, a, 6)[1:] if angle else [0.0]:
            u = mesh.points @ (rotation(turn) - np.eye(2)).T
            held = [Fixed([int(n)], d, float(u[n, d])) for n in bottom for d in (0, 1)]
            if element in DRILLING:
                held += [Fixed([int(n)], 2, float(turn)) for n in bottom]
            steps.append(ct.Static(supports=held, increments=1))
        upper = mesh.nodes_of("high")
        steps.append(ct.Static(loads=[Temperature(upper, 8.0)], increments=2))
        results = ct.solve(model, steps, threads=1)
        before = [f for f in results.frames if f.step == len(steps) - 1][-1]
        assert max(np.abs(b.values["S"]).max() for b in before.fields) < 1e-7
        S = np.concatenate([b.values["S"].reshape(-1, 4) for b in results.frames[-1].fields])
        full = np.array([[[s[0], s[3]], [s[3], s[1]]] for s in S])
        R = rotation(a)
        stresses.append(R.T @ full @ R)
    assert np.abs(stresses[0]).max() > 0.05
    assert np.allclose(stresses[1], stresses[0], atol=1e-7)
