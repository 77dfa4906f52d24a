"""Annulus in steady spin: displacements and hoop stresses from centrifugal forces.

Radii 0.1 and 0.5 m, E = 70 GPa, nu = 0.3, density 2700 kg/m^3, 200 rad/s, plane stress. The inner
edge grows by 3.209142857e-5 m and the outer by 4.011428571e-5 m; the hoop stresses there are 22.464
and 5.616 MPa.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Picture, Problem, Study, Value
from corota.verification.models import DRILLING, cell, nearest, run

INNER, OUTER, SPEED = 0.1, 0.5, 200.0
EXACT = {"inner": (3.209142857e-5, 22.464e6), "outer": (4.011428571e-5, 5.616e6)}


def solved(element: str, n: int) -> ct.Results:
    """Quarter of the annulus, `n` cells across."""
    model = ct.Model(ct.mesh.annulus(INNER, OUTER, n, 2 * n, angle=90.0, cell=cell(element)))
    model.section("all", element=element, material=ct.Elastic(E=70e9, nu=0.3, rho=2700.0))
    turn = 0.0 if element in DRILLING else None
    model.fix("start", x=None, rotation=turn)
    model.fix("end", y=None, rotation=turn)
    model.loads.append(ct.BodyForce("", "centrifugal", (SPEED**2, 0.0, 0.0)))
    return run(model, ct.Static(nlgeom=False), fields=True)


def growth(results: ct.Results, edge: str) -> float:
    """Mean radial displacement of an edge."""
    nodes = results.mesh.node_sets[edge]
    return float(np.hypot(*results.frames[-1].U[nodes].T).mean())


def measure() -> Iterator[Value]:
    """Growth for three elements, stresses for one."""
    for element, n, tolerance in (
        ("Q8", 16, 1e-4),
        ("Q4I", 32, 5e-3),
        ("Q4D", 32, 5e-3),
        ("OPT", 32, 5e-3),
    ):
        results = solved(element, n)
        for edge, (exact, _) in EXACT.items():
            yield Value(
                f"growth of the {edge} edge [m], {element} {n} x {2 * n}",
                exact,
                growth(results, edge),
                tolerance,
            )
    results = solved("Q9", 32)
    for edge, radius in (("inner", INNER), ("outer", OUTER)):
        stress = float(results.nodal("S22")[nearest(results.mesh, radius, 0.0)])
        yield Value(
            f"hoop stress at the {edge} edge [Pa], Q9 16 x 32", EXACT[edge][1], stress, 0.01
        )


def study() -> Study:
    """Error of the growth of the inner edge."""
    return Study.over(
        "error of the growth of the inner edge",
        ("Q4I", "Q4D", "OPT", "T6", "Q8"),
        (2, 4, 8, 16),
        lambda e, n: abs(growth(solved(e, n), "inner") / EXACT["inner"][0] - 1.0),
        "cells across",
    )


PROBLEM = Problem(
    title="Spinning annulus",
    group="dynamics",
    source="S. P. Timoshenko, J. N. Goodier, Theory of Elasticity, section 32",
    certainty="analytic",
    why="mesh error; stresses at the edge are extrapolated from points inside",
    picture=lambda: Picture(solved("Q8", 8), "MISES", 1000.0),
    seconds=1.0,
)
