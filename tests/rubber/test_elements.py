"""Hyperelastic bodies of every element in homogeneous states, in one increment."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.model import elements
from corota.verification.models import DRILLING, cell
from support.pairs import cover

PLANAR = [name for name in elements.names() if not elements.find(name).weighted]
RUBBER = {
    "neo-Hooke": ct.NeoHooke(C10=0.5, D1=0.02),
    "Ogden": ct.Ogden(mu=(0.7, 0.05), alpha=(2.5, -3.0), D=0.05),
    "foam": ct.Hyperfoam(mu=0.5, alpha=4.0, nu=0.2),
}
MEAN = {"Q4", "Q4D", "Q8", "Q8R", "Q9"}


def options(element: str, plane: str) -> dict[str, Any]:
    return {"mean_dilatation": plane == "strain" and element in MEAN}


def nominal(law: Any, plane: str, stretch: float) -> tuple[float, float]:
    """Nominal stress and transverse strain of a free bar, from the law at a point."""
    axial, side = np.log(stretch), 0.0
    for _ in range(60):
        raw = law.respond([axial, side, 0.0], plane)
        side -= raw["stress"][0, 1] / raw["tangent"][0, 1, 1]
    return float(raw["stress"][0, 0] / stretch), side


@pytest.mark.parametrize(("element", "plane", "name"), cover(PLANAR, ["strain", "stress"], RUBBER))
def test_pulled_and_turned_block(element: str, plane: Any, name: str) -> None:
    """A distorted mesh stretched by 1.6 and turned by 70 degrees at once: force, thickness."""
    law, stretch, turn = RUBBER[name], 1.6, np.radians(70.0)
    mesh = ct.mesh.distort(ct.mesh.rectangle(2.0, 1.0, 2, 2, cell(element)), 0.2)
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=law, plane=plane, thickness=0.5, **options(element, plane)
    )
    force, side = nominal(law, plane, stretch)
    c, s = np.cos(turn), np.sin(turn)
    F = np.array([[c, -s], [s, c]]) @ np.diag([stretch, np.exp(side)])
    edge = np.unique(np.concatenate([mesh.nodes_of(e) for e in ("left", "right", "top", "bottom")]))
    for node in edge:
        x, y = (F - np.eye(2)) @ mesh.points[node]
        model.fix([node], x=x, y=y, rotation=turn if element in DRILLING else None)
    frame = ct.solve(model, ct.Static(increments=1), threads=1).frames[-1]
    values = frame.fields[0].values
    n, area = F[:, 0] / stretch, stretch * np.exp(side)
    zz = law.respond([np.log(stretch), side, 0.0], plane)["zz"][0]
    cauchy = force * stretch / area / np.exp(zz[0])
    tensor = cauchy * np.outer(n, n)
    expected = [tensor[0, 0], tensor[1, 1], zz[1] / area / np.exp(zz[0]), tensor[0, 1]]
    # The rotation of a drilling element is tied to the skew gradient, which is linear.
    error = 1e-3 if element in DRILLING else 1e-8
    assert np.abs(values["S"] - expected).max() < error * max(1.0, abs(cauchy))
    assert np.abs(values["E"][..., 2] - zz[0]).max() < error
    reaction = frame.RF[mesh.nodes_of("right")].sum(axis=0)[:2]
    assert reaction == pytest.approx(force * 0.5 * n, abs=error)
    work = frame.scalars["strain energy"]
    energy = law.respond([np.log(stretch), side, 0.0], plane)["energy"][0]
    assert work == pytest.approx(energy * 2.0 * 0.5, rel=error)


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q4S", "Q4R", "Q8", "T3", "T6"])
def test_incompressible_sheet(element: str) -> None:
    """Plane stress with D = 0: a sheet pulled to twice its length in one increment."""
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 2, 2, cell(element)))
    model.section("all", element=element, material=ct.NeoHooke(C10=0.5), thickness=0.1)
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=0.0, y=0.0)
    model.fix("right", x=2.0, y=None)
    frame = ct.solve(model, ct.Static(increments=1), threads=1).frames[-1]
    force = frame.RF[model.mesh.nodes_of("right"), 0].sum()
    assert force == pytest.approx(0.1 * (2.0 - 0.25), rel=1e-8)
    assert frame.fields[0].values["STH"] == pytest.approx(0.1 / 2.0**0.5, rel=1e-8)


def test_linear_step_is_computed_with_large_rotations() -> None:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 1, 1))
    model.section("all", element="Q4", material=ct.NeoHooke(C10=0.5))
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=0.0, y=0.0)
    model.fix("right", x=2.0, y=None)
    with pytest.warns(UserWarning, match="a hyperelastic law is for finite strain"):
        results = ct.solve(model, ct.Static(nlgeom=False), threads=1)
    force = results.frames[-1].RF[model.mesh.nodes_of("right"), 0].sum()
    assert force == pytest.approx(2.0 - 0.25, rel=1e-8)


def test_refuses_thermal_strain_in_plane_strain() -> None:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 1, 1))
    law = ct.NeoHooke(C10=0.5, D1=0.01, expansion=1e-4)
    model.section("all", element="Q4S", material=law, plane="strain")
    model.fix("left")
    model.temperature(100.0)
    with pytest.raises(ct.InputError, match="no thermal strain in plane strain"):
        ct.solve(model, ct.Static(), threads=1)


def test_refuses_opt() -> None:
    model = ct.Model(ct.mesh.rectangle(2.0, 1.0, 1, 1, "tri3"))
    with pytest.raises(ct.InputError, match="OPT is for local strains of a few percent"):
        model.section("all", element="OPT", material=ct.NeoHooke(C10=0.5))
