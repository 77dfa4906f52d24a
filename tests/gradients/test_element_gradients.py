"""Gradients of weighted forces and new histories of elements beside differences of both.

A gradient goes back through the derivatives of the laws at the points; differences evaluate the
elements alone.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import corota as ct
from corota.analysis.equations import System
from corota.analysis.linear.solvers import make_solver
from corota.gradients.differences import STENCIL

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

LAWS = {
    "elastic": ct.Elastic(E=1000.0, nu=0.3),
    "mises": ct.Mises(1000.0, 0.3, yield_stress=8.0, isotropic=60.0),
    "recall": ct.Mises(1000.0, 0.3, yield_stress=8.0, chaboche=[(400.0, 40.0), (90.0, 5.0)]),
    "hill": ct.Hill(
        R11=1.0, R22=1.1, R33=0.95, R12=1.02, E=1000.0, nu=0.3, yield_stress=8.0, isotropic=60.0
    ),
    "prony": ct.Viscoelastic(ct.Elastic(E=1000.0, nu=0.3), terms=[(0.3, 0.1, 0.2)]),
    "prony_neo_hooke": ct.Viscoelastic(
        ct.NeoHooke(C10=170.0, D1=0.004), terms=[(0.3, 0.1, 0.2), (0.1, 0.0, 2.0)]
    ),
}
CASES = [
    ("T3", "tri3", "mises", "strain"),
    ("T6", "tri6", "recall", "stress"),
    ("Q4", "quad4", "prony", "strain"),
    ("Q4I", "quad4", "mises", "stress"),
    ("Q4I", "quad4", "recall", "strain"),
    ("Q4I", "quad4", "prony_neo_hooke", "stress"),
    ("Q4I", "quad4", "hill", "axisymmetric"),
    ("Q4I", "quad4", "elastic", "stress"),
    ("Q8R", "quad8", "mises", "axisymmetric"),
    ("Q9", "quad9", "recall", "strain"),
    ("OPT", "tri3", "mises", "stress"),
    ("Q4D", "quad4", "recall", "stress"),
    ("Q4DI", "quad4", "mises", "strain"),
    ("Q4R", "quad4", "mises", "stress"),
    ("Q4S", "quad4", "mises", "strain"),
    ("BEAM", "line2", "mises", "stress"),
    ("TRUSS", "line2", "recall", "stress"),
]


def flowing(element: str, cell: str, law: str, plane: str) -> tuple[System, Floats, float]:
    """Elements with a history, and displacements at which they flow on; their size."""
    rng = np.random.default_rng(3)
    if cell == "line2":
        points = np.column_stack([np.arange(4.0), [0.0, 0.1, 0.0, 0.2]])
        chain = np.column_stack([np.arange(3), np.arange(1, 4)])
        cells = [ct.mesh.Cells("line2", chain, np.arange(1, 4))]
        mesh = ct.Mesh(points, cells, np.arange(1, 5))
    else:
        mesh = ct.mesh.rectangle(2.0, 1.0, nx=2, ny=1, cell=cell, origin=(3.0, 0.0))
    model = ct.Model(mesh)
    if element == "BEAM":
        profile = ct.profiles.rectangle(0.4, 0.3)
        model.beam([0, 1, 2], material=LAWS[law], profile=profile)
    elif element == "TRUSS":
        model.truss([0, 1, 2], material=LAWS[law], area=0.7)
    else:
        model.section("all", element=element, material=LAWS[law], plane=plane)
    system = System(model, make_solver("multifrontal"), 1)
    step = ct.Static(nlgeom=True)
    system.begin(step, 0.0, np.zeros(system.n_dofs), None)
    size = 0.03
    u = np.zeros(system.n_dofs)
    for _ in range(2):
        turn = 0.4 * (mesh.points - 3.0) @ np.array([[0.0, 1.0], [-1.0, 0.0]])
        by_node = np.zeros((mesh.n_nodes, 3))
        by_node[:, :2] = 0.2 * turn + size * rng.normal(size=mesh.points.shape)
        u = system.from_nodes(by_node)
        system.forces(u, 1.0)
        system.commit()
    more = size * rng.normal(size=system.n_dofs)
    return system, u + more, size


def slopes(function: Callable[[float], float], step: float) -> float:
    return sum(weight * function(k * step) for k, weight in STENCIL) / step


@pytest.mark.parametrize("case", CASES, ids="-".join)
def test_gradient_is_the_difference(case: tuple[str, str, str, str]) -> None:
    system, u, size = flowing(*case)
    core, rng = system.core, np.random.default_rng(4)
    system.forces(u, 1.0)
    known = core.histories(False)
    force = rng.normal(size=system.n_dofs)
    state = [50.0 * rng.normal(size=len(h)) for h in known]
    if case[0] == "BEAM":
        # Weights of an increment after: fibers without an area and the modes, where an iteration
        # begins, have none.
        after = rng.normal(size=system.n_dofs)
        state = core.differentiate(u, True, after, [], ["state"])["state"]
    found = core.differentiate(u, True, force, state, ["displacements", "state"])

    def total(at: Floats, histories: list[Floats]) -> float:
        core.set_histories(histories)
        internal = system.forces(at, 1.0).internal
        new = core.histories(True)
        return float(force @ internal + sum(w @ h for w, h in zip(state, new, strict=True)))

    rows = rng.choice(system.n_dofs, 4, replace=False)
    top = np.abs(found["displacements"]).max()
    for row in rows:
        one = np.eye(system.n_dofs)[row]
        slope = slopes(lambda v, one=one: total(u + v * one, known), 1e-4 * size)
        assert abs(slope - found["displacements"][row]) < 2e-7 * top
    if not len(known[0]):
        return
    top = np.abs(found["state"][0]).max()
    for row in rng.choice(len(known[0]), 6, replace=False):
        one = np.eye(len(known[0]))[row]
        slope = slopes(lambda v, one=one: total(u, [known[0] + v * one]), 1e-5)
        assert abs(slope - found["state"][0][row]) < 2e-7 * top
