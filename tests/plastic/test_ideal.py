"""Flow without hardening: where all of a part flows, its tangent has modes without stiffness.

In uniaxial plane stress the tangent of a point has none along the flow, and elements that can
spread the flow unevenly (internal modes, reduced integration) pass that on to the structure. The
force is unique all the same, and default settings go on.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import corota as ct
from corota.model import elements
from support.pairs import cover

#: At finite strain a bar without hardening necks, which is said; the uniform state is followed.
pytestmark = pytest.mark.filterwarnings("ignore:.*bifurcation or limit point:UserWarning")

E, NU, YIELD = 1000.0, 0.3, 1.0
IDEAL = {
    "perfect": ct.Mises(E, NU, yield_stress=YIELD),
    "table": ct.Mises(E, NU, yield_curve=[(0.6, 0.0), (1.0, 1e-3)]),
    "saturated": ct.Mises(E, NU, yield_stress=0.6, isotropic=ct.Voce(0.4, 2e4)),
    "recall": ct.Mises(E, NU, yield_stress=0.6, chaboche=[(4000.0, 1e4)]),
}
PLANAR = [n for n in elements.names() if elements.find(n).revolved]


def strip(element: str, plane: str, law: Any, nx: int, ny: int, skew: float = 0.0) -> ct.Model:
    mesh = ct.mesh.rectangle(float(nx), float(ny), nx, ny, cell=elements.find(element).cell)
    x, y = mesh.points.T.copy()
    mesh.points[:, 0] += skew * np.sin(np.pi * x / nx) * np.sin(2.3 * y)
    mesh.points[:, 1] += skew * np.sin(np.pi * y / ny) * np.sin(1.7 * x + 0.3)
    model = ct.Model(mesh)
    section: dict[str, Any] = {} if plane == "axisymmetric" else {"thickness": 1.0}
    model.section("all", element=element, material=law, plane=plane, **section)
    return model


def pulled(model: ct.Model, way: float, nlgeom: bool) -> float:
    """Force along x after pulling the right end, free across."""
    model.fix("left", x=0.0, y=None)
    model.fix([int(np.argmin(np.abs(model.mesh.points).sum(axis=1)))], x=None, y=0.0)
    step = ct.Static(nlgeom=nlgeom)
    step.fix("right", x=way, y=None)
    frame = ct.solve(model, step, threads=1).frames[-1]
    return float(frame.RF[model.mesh.node_sets["right"], 0].sum())


@pytest.mark.parametrize(
    ("element", "plane", "nlgeom", "sign"),
    cover(PLANAR, ["stress", "strain"], [False, True], [1.0, -1.0]),
)
def test_a_bar_carries_its_yield_force_on(
    element: str, plane: str, nlgeom: bool, sign: float
) -> None:
    """One element, a row, and a skewed mesh, to five times the strain of yield, by default."""
    limit = YIELD if plane == "stress" else 2.0 / np.sqrt(3.0) * YIELD
    for nx, ny, skew in ((1, 1, 0.0), (3, 1, 0.0), (6, 2, 0.2)):
        model = strip(element, plane, IDEAL["perfect"], nx, ny, skew)
        force = pulled(model, sign * 0.005 * nx, nlgeom)
        # The stress is conjugate to the logarithmic strain; plane strain still creeps to its limit.
        exact = sign * limit * ny / (1.0 + sign * 0.005 if nlgeom else 1.0)
        assert force == pytest.approx(exact, rel=2e-5 if plane == "stress" else 1e-3)


@pytest.mark.parametrize("law", IDEAL)
@pytest.mark.parametrize("element", ["Q4I", "Q4S", "Q4R", "Q8R"])
def test_every_law_whose_hardening_ends(law: str, element: str) -> None:
    model = strip(element, "stress", IDEAL[law], 3, 1)
    # One implicit increment leaves 1 / (1 + gamma dp) of the recalled back-stress.
    missing = 0.4 / (1.0 + 1e4 * 0.009) if law == "recall" else 0.0
    assert pulled(model, 0.03, False) == pytest.approx(YIELD - missing, rel=1e-4)


@pytest.mark.parametrize(
    ("element", "sign"), cover(["Q4I", "Q4S", "Q8", "Q8R"], [1.0, -1.0], strength=1)
)
def test_a_beam_turns_at_its_plastic_moment(element: str, sign: float) -> None:
    """sy h^2 / 4 in plane stress, the end turned to twenty times the curvature of yield."""
    model = strip(element, "stress", IDEAL["perfect"], 6, 4)
    end = ct.mesh.add_node(model.mesh, 6.0, 2.0, "end")
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    model.rigid("right", end)
    step = ct.Static(nlgeom=False)
    step.fix("end", x=None, y=None, rotation=sign * 20.0 * 6.0 * YIELD / E / 2.0)
    moment = ct.solve(model, step, threads=1).frames[-1].RF[end, 2]
    assert moment == pytest.approx(sign * YIELD * 4.0**2 / 4.0, rel=0.03)


@pytest.mark.parametrize("element", PLANAR)
def test_pulled_back_and_forth(element: str) -> None:
    """Yield force in the other direction after reversal, and zero stress on the way."""
    model = strip(element, "stress", IDEAL["perfect"], 3, 1)
    model.fix("left", x=0.0, y=None)
    model.fix([0], x=None, y=0.0)
    steps = []
    for way in (0.015, -0.015, 0.015):
        step = ct.Static(nlgeom=False)
        step.fix("right", x=way, y=None)
        steps.append(step)
    results = ct.solve(model, steps, threads=1)
    right = model.mesh.node_sets["right"]
    ends = [[f for f in results.frames if f.step == n][-1] for n in (1, 2, 3)]
    forces = [float(f.RF[right, 0].sum()) for f in ends]
    assert forces == pytest.approx([YIELD, -YIELD, YIELD], rel=1e-6)
