"""Mean dilatation: exact tangent, constant-strain patch, refusals; the weight of OPT."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota import _core
from corota.verification.plastic_models import CELL, notched

SHAPES = {"quad4": 4, "quad8": 8, "quad9": 9}
QUADS = ["Q4", "Q4D", "Q8", "Q8R", "Q9"]


PLASTIC = ct.Mises(E=1000.0, nu=0.45, yield_stress=8.0, isotropic=40.0)
#: Local strain, law, size of the displacements in an element of size 2.
CASES: list[tuple[str, Any, float]] = [
    ("linear", PLASTIC, 0.03),
    ("logarithmic", PLASTIC, 0.03),
    ("logarithmic", ct.NeoHooke(C10=0.5, D1=0.002), 0.25),
    ("green_lagrange", ct.Elastic(E=1000.0, nu=0.45), 0.25),
]


def element(
    name: str, measure: str, u: np.ndarray, law: Any = PLASTIC
) -> tuple[np.ndarray, np.ndarray]:
    """Force and tangent of one distorted element in plane strain."""
    mesh = ct.mesh.mapped([(0, 0), (2, 0.3), (2.2, 1.6), (-0.1, 1.2)], 1, 1, CELL[name])
    block = {
        "element": name,
        "law": law.law,
        "parameters": law.parameters(),
        "plane": "strain",
        "local_strain": measure,
        "thickness": 1.3,
        "rho": 0.0,
        "mean_dilatation": True,
        "nodes": mesh.cells[0].nodes[0].astype(np.uint32),
    }
    core = _core.Problem(mesh.points, [block], np.zeros(0, np.uint8))
    n = core.n_dofs
    force, scale, values = np.empty(n), np.empty(n), np.empty(len(core.indices))
    core.assemble(u[:n], True, force, scale, values)
    upper = np.zeros((n, n))
    columns = np.repeat(np.arange(n), np.diff(core.indptr.astype(int)))
    upper[core.indices.astype(int), columns] = values
    return force, upper + np.triu(upper, 1).T


@pytest.mark.parametrize(("measure", "law", "size"), CASES)
@pytest.mark.parametrize("name", QUADS)
def test_tangent(name: str, measure: str, law: Any, size: float) -> None:
    u = np.random.default_rng(2).uniform(-size, size, 18)
    force, tangent = element(name, measure, u, law)
    n = len(force)
    difference = np.empty((n, n))
    for j in range(n):
        step = np.zeros(18)
        step[j] = 1e-6
        plus, minus = (element(name, measure, u + s * step, law)[0] for s in (1, -1))
        difference[:, j] = (plus - minus) / 2e-6
    assert np.abs(difference - tangent).max() < 1e-6 * np.abs(tangent).max()


@pytest.mark.parametrize("name", QUADS)
def test_patch(name: str) -> None:
    """Distorted meshes carry constant strain."""
    mesh = ct.mesh.distort(ct.mesh.rectangle(4.0, 3.0, 4, 3, CELL[name]), 0.3)
    model = ct.Model(mesh)
    law = ct.Elastic(E=100.0, nu=0.499)
    model.section("all", element=name, material=law, plane="strain", mean_dilatation=True)
    x, y = mesh.points.T
    edge = np.flatnonzero((x < 1e-9) | (x > 4 - 1e-9) | (y < 1e-9) | (y > 3 - 1e-9))
    turn = 0.0 if name == "Q4D" else None
    for node in edge:
        model.fix(
            [node],
            x=1e-3 * (x[node] + y[node] / 2),
            y=1e-3 * (x[node] / 2 - y[node]),
            rotation=turn,
        )
    frame = ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1]
    strain = frame.fields[0].values["E"]
    assert np.abs(strain - [1e-3, -1e-3, 0.0, 1e-3]).max() < 1e-12


def test_refuses() -> None:
    model = ct.Model(ct.mesh.rectangle(1.0, 1.0, 1, 1))
    law: Any = {"material": ct.Elastic(E=1.0)}
    with pytest.raises(ct.InputError, match="mean dilatation is for plane strain"):
        model.section("all", element="Q4", mean_dilatation=True, **law)
    with pytest.raises(ct.InputError, match="mean dilatation is for quadrilaterals, not OPT"):
        model.section("all", element="OPT", plane="strain", mean_dilatation=True, **law)
    with pytest.raises(ct.InputError, match="Q4I does not lock"):
        model.section("all", element="Q4I", plane="strain", mean_dilatation=True, **law)
    with pytest.raises(ct.InputError, match="only OPT has this weight"):
        model.section("all", element="Q4", beta0=0.1, **law)
    with pytest.raises(ct.InputError, match="must be > 0"):
        model.section("all", element="OPT", beta0=-0.1, **law)


def test_weight_of_opt_is_the_default_one() -> None:
    """``beta0 = (1 - 4 nu^2) / 2`` in plane stress gives what no weight gives."""
    tips = []
    for beta0 in (None, 0.5 * (1 - 4 * 0.3**2), 0.05):
        model = ct.Model(ct.mesh.rectangle(10.0, 1.0, 10, 2, "tri3"))
        model.section("all", element="OPT", material=ct.Elastic(E=1000.0, nu=0.3), beta0=beta0)
        model.fix("left")
        model.traction("right", y=-0.01)
        tips.append(ct.solve(model, ct.Static(nlgeom=False), threads=1).frames[-1].U.min())
    assert tips[0] == pytest.approx(tips[1], rel=1e-12)
    assert tips[2] < 1.02 * tips[0]


def test_notched_specimen_keeps_its_volume() -> None:
    """Without mean dilatation Q4D is far too stiff where the material flows."""
    loads = []
    for mean in (False, True):
        model = notched("Q4D", 4, 0.1, mean_dilatation=mean)
        frame = ct.solve(model, ct.Static(nlgeom=False, increments=5), threads=1).frames[-1]
        loads.append(frame.scalars["external work"])
    assert loads[1] < 0.95 * loads[0]
