"""Plastic work of the energy-momentum scheme: in balance, and that of a closed form."""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import corota as ct
from tests.support.models import cell
from tests.support.pairs import cover

YOUNG, YIELD, HARD = 1e4, 20.0, 500.0
LENGTH, HEIGHT = 10.0, 1.0


def dissipated(energy: float) -> float:
    """Plastic work of a bar without mass that stops a mass with that kinetic energy.

    Uniaxial, geometrically linear: 1/2 k d^2 to yield, then the slope k H / (E + H). The mass
    swings on without more flow where hardening is isotropic.
    """
    stiffness = YOUNG * HEIGHT / LENGTH
    force = YIELD * HEIGHT
    slope = stiffness * HARD / (YOUNG + HARD)
    first = force / stiffness
    # 1/2 slope d^2 + force d = what the elastic part leaves.
    left = energy - 0.5 * force * first
    beyond = (math.sqrt(force**2 + 2.0 * slope * left) - force) / slope
    end = force + slope * beyond
    return energy - 0.5 * end**2 / stiffness


def stopped(element: str, energy: float, increments: int) -> ct.Results:
    """The bar stretched by a mass; the first stroke and some of the swing."""
    model = ct.Model(ct.mesh.rectangle(LENGTH, HEIGHT, nx=2, ny=1, cell=cell(element)))
    law = ct.Mises(E=YOUNG, nu=0.0, yield_stress=YIELD, isotropic=HARD, rho=1e-9)
    model.section(element=element, material=law)
    model.fix("left", y=None)
    model.fix("bottom", x=None)
    nodes = model.mesh.node_sets["right"]
    model.point_mass("right", 1.0 / len(nodes))
    for node in nodes[1:]:
        model.equation((int(node), "x", 1.0), (int(nodes[0]), "x", -1.0))
    speed = math.sqrt(2.0 * energy)
    model.velocity("right", x=speed)
    step = ct.Dynamic(
        period=1.5 * 2.0 * energy / (YIELD * HEIGHT) / speed,
        increments=increments,
        scheme="energy_momentum",
        nlgeom=False,
        max_iterations=60,
    )
    return ct.solve(model, step, threads=1)


@pytest.mark.parametrize("element", ["Q4", "Q4I", "Q8R", "Q9", "Q4R", "Q4D", "OPT", "T6"])
def test_plastic_work_is_that_of_the_closed_form(element: str) -> None:
    """Few increments, of which one begins elastic and ends in flow."""
    energy = 4.0
    exact = dissipated(energy)
    found = [float(stopped(element, energy, n).history("ALLPD")[-1]) for n in (11, 22)]
    assert found[0] == pytest.approx(exact, rel=0.02)
    assert found[1] == pytest.approx(exact, rel=0.008)


LAWS: dict[str, dict[str, Any]] = {
    "isotropic": {"isotropic": HARD},
    "Voce": {"isotropic": ct.Voce(Q=10.0, b=30.0)},
    "kinematic": {"kinematic": HARD},
    "combined": {"isotropic": HARD, "kinematic": HARD},
}


@pytest.mark.parametrize(
    ("element", "law", "strain"), cover(["Q4I", "Q4D", "T3"], LAWS, ["linear", "logarithmic"])
)
def test_energy_is_in_balance_while_a_beam_yields(element: str, law: str, strain: str) -> None:
    """A clamped beam is kicked sideways and yields in some ten increments."""
    model = ct.Model(ct.mesh.rectangle(LENGTH, HEIGHT, nx=8, ny=2, cell=cell(element)))
    material = ct.Mises(E=YOUNG, nu=0.3, yield_stress=YIELD, rho=1.0, **LAWS[law])
    model.section(element=element, material=material, plane="strain", local_strain=strain)
    model.fix("left", rotation=element == "Q4D")
    model.velocity(y=0.7)
    step = ct.Dynamic(period=4.0, increments=40, scheme="energy_momentum", max_iterations=60)
    results = ct.solve(model, step, threads=1)
    spent = results.history("ALLPD").values
    assert spent[-1] > 0.2 * results.history("ALLKE")[0]
    back = 1e-7 if law in ("isotropic", "Voce") else 1e-2
    assert np.diff(spent).min() >= -back * spent[-1]
    # Rounding in small changes of elements that hardly flow.
    assert np.abs(results.history("energy balance error").values).max() < 1e-7
