"""Impulse and change of momentum of a free body under a sudden force on its skin.

Source of the expected values: Newton's second law, ``p = F t`` and ``L = int x x F dt`` along the
path of the loaded node. Schemes with a constant mass matrix fulfil the first to rounding; where
inertia depends on the configuration they are of second order. The energy-momentum scheme fulfils
both to rounding with any mass.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

import numpy as np
import pytest

import corota as ct
from support.models import cell

ELEMENTS = ["T3", "T6", "Q4", "Q4I", "Q4S", "Q4R", "Q8", "Q8R", "Q9", "OPT", "Q4D", "Q4DI"]
DRILLING = ("OPT", "Q4D", "Q4DI")
MASSES = ["consistent", "constant", "lumped"]
SCHEMES = ["newmark", "hht", "generalized_alpha", "energy_momentum"]
#: Quick: every element with every scheme, one mass for each, a pair with every other one. So
#: each element has each mass, and each scheme an inertia that depends on the configuration.
EVERY = [
    pytest.param(
        e,
        m,
        s,
        pair,
        id=f"{e}-{m}-{s}-{'pair' if pair else 'free'}",
        marks=[] if n == (i + j) % 3 and pair == ((i + j) % 2 == 1) else [pytest.mark.slow],
    )
    for i, s in enumerate(SCHEMES)
    for j, e in enumerate(ELEMENTS)
    for n, m in enumerate(MASSES)
    for pair in (False, True)
]
FORCE, END = np.array([20.0, 10.0]), 0.02
ROUNDING = 1e-11


def errors(element: str, mass: str, scheme: str, pair: bool, increments: int) -> np.ndarray:
    """Errors of momentum over ``F t``, the worse of all frames, and of angular momentum at the end.

    A block of unequal sides, three elements through its height; the pair is never closed.
    """
    mesh = ct.mesh.rectangle(4.0, 1.0, nx=4, ny=3, cell=cell(element))
    model = ct.Model(mesh)
    model.section("all", element=element, material=ct.Elastic(E=1e4, nu=0.3, rho=1.5))
    if pair:
        model.contact("bottom", ct.RigidCurve.line((-99.0, -90.0), (99.0, -90.0)))
    node = int(np.abs(mesh.points - [1.0, 0.0]).sum(axis=1).argmin())
    model.force([node], x=FORCE[0], y=FORCE[1])
    step = ct.Dynamic(
        period=END,
        increments=increments,
        scheme=scheme,
        mass=mass,
        tolerance=1e-12,
        max_iterations=30,
    )
    frames = ct.solve(model, step, fields=False, threads=1).frames
    time = np.array([f.time for f in frames])
    p = np.array([[f.scalars[f"momentum {i}"] for i in "xy"] for f in frames])
    linear = np.abs(p[1:] - np.outer(time[1:], FORCE)) / (END * FORCE)
    x = np.array([mesh.points[node] + f.U[node] for f in frames])
    moment = x[:, 0] * FORCE[1] - x[:, 1] * FORCE[0]
    impulse = float(np.sum(0.5 * (moment[1:] + moment[:-1]) * np.diff(time)))
    angular = frames[-1].scalars["angular momentum"] / impulse - 1.0
    return np.array([linear.max(), abs(angular)])


@pytest.mark.parametrize(("element", "mass", "scheme", "pair"), EVERY)
def test_impulse_is_the_change_of_momentum(
    element: str, mass: str, scheme: str, pair: bool
) -> None:
    changes = mass == "consistent" and element in DRILLING and scheme != "energy_momentum"
    fine = errors(element, mass, scheme, pair, 32)
    if changes:
        # Four times shorter increments: an order of two gives 16.
        coarse = errors(element, mass, scheme, pair, 8)
        assert fine[0] < 1e-5
        assert fine[0] < coarse[0] / 6.0
    else:
        assert fine[0] < ROUNDING
    assert fine[1] < (ROUNDING if scheme == "energy_momentum" else 1e-5)
