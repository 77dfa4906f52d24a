"""Springs: in series, to the ground, torsional, nonlinear, and a stiff column on a torsion spring.

Two springs in series with the same force; a nonlinear spring that is loaded beyond the corner of
its curve, up to the constant part; a torsion spring under a moment. A nearly rigid column stands on
a torsion spring under a load on its top: it buckles at P = k / L and follows P L sin(phi) = k phi,
here with a small moment on its foot.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.models import run

STIFFNESS, LENGTH, NUDGE = 50.0, 2.0, 2.0
LOADS = np.array([0.4, 0.8, 1.0, 1.2, 1.6, 2.0])


def parts(points: list[tuple[float, float]], *cells: tuple[str, list[list[int]]]) -> ct.Mesh:
    """A mesh of lines and points."""
    blocks, label = [], 1
    for kind, nodes in cells:
        array = np.array(nodes)
        blocks.append(ct.Cells(kind, array, np.arange(label, label + len(array))))
        label += len(array)
    return ct.Mesh(np.array(points), blocks, np.arange(1, len(points) + 1))


def row() -> tuple[float, float]:
    """Elongations of two springs of 10 and 40 in a row under a force of 2."""
    model = ct.Model(parts([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], ("line2", [[0, 1], [1, 2]])))
    model.spring([0], 10.0)
    model.spring([1], 40.0)
    model.fix([0])
    model.fix([1, 2], x=None)
    model.force([2], x=2.0)
    u = run(model, ct.Static(nlgeom=False)).frames[-1].U[:, 0]
    return float(u[1]), float(u[2] - u[1])


def stretched(x: float) -> float:
    """Force of a spring with a curve at an elongation."""
    model = ct.Model(parts([(0.0, 0.0), (1.0, 0.0)], ("line2", [[0, 1]])))
    model.spring([0], [(-1.0, -2.0), (0.0, 0.0), (0.1, 1.0), (0.5, 1.8)])
    model.fix([0])
    model.fix([1], x=x, y=0.0)
    return float(run(model, ct.Static(increments=5)).frames[-1].RF[1, 0])


def column(load: float, nudge: float) -> ct.Model:
    """A stiff column on a torsion spring; `nudge` is a moment on its foot."""
    model = ct.Model(parts([(0.0, 0.0), (0.0, LENGTH)], ("line2", [[0, 1]]), ("point1", [[0]])))
    model.beam([0], material=ct.Elastic(E=1e9, nu=0.0), area=1.0, inertia=1.0)
    model.spring([1], STIFFNESS, "rotation")
    model.fix([0])
    model.force([1], y=-load)
    if nudge:
        model.force([0], moment=-nudge)
    return model


def angle(load: float) -> float:
    """Angle of the column from the vertical, computed, for P over k / L."""
    model = column(load * STIFFNESS / LENGTH, NUDGE)
    return -float(run(model, ct.Static(increments=20)).frames[-1].UR[0])


def exact(load: float) -> float:
    """The same by the balance of moments."""
    return float(brentq(lambda a: load * np.sin(a) + NUDGE / STIFFNESS - a, 1e-9, np.pi))


def measure() -> Iterator[Value]:
    """All of them."""
    for name, known, found in zip(("first", "second"), (0.2, 0.05), row(), strict=True):
        yield Value(f"elongation of the {name} of two springs", known, found, 1e-12)
    for x, force in ((-0.5, -1.0), (0.05, 0.5), (0.3, 1.4), (0.9, 1.8)):
        yield Value(f"force of the curve at {x:g}", force, stretched(x), 1e-9)
    model = ct.Model(parts([(0.0, 0.0), (1.0, 0.0)], ("line2", [[0, 1]]), ("point1", [[0]])))
    model.beam([0], material=ct.Elastic(E=1e9, nu=0.0), area=1.0, inertia=1.0)
    model.spring([1], STIFFNESS, "rotation")
    model.fix([0])
    model.force([1], moment=100.0)
    turn = run(model, ct.Static(increments=2)).frames[-1].UR[0]
    yield Value("turn of the torsion spring [rad]", 100.0 / STIFFNESS, turn, 1e-6)
    factor = run(column(1.0, 0.0), ct.Buckle()).modes[0].factors[0]
    yield Value("buckling load of the column", STIFFNESS / LENGTH, factor, 1e-6)
    for load in LOADS:
        yield Value(f"angle of the column at P L / k = {load:g}", exact(load), angle(load), 1e-6)


def curve() -> Curve:
    """Load against angle."""
    loads = np.linspace(0.02, 2.0, 60)
    return Curve(
        "angle from the vertical [rad]",
        "P L / k",
        {"balance of moments": ([exact(p) for p in loads], loads)},
        {"beam and torsion spring": ([angle(p) for p in LOADS], LOADS)},
    )


PROBLEM = Problem(
    title="Springs, and a column on one",
    group="paths and buckling",
    source="statics; S. P. Timoshenko, J. M. Gere, Theory of Elastic Stability (1961)",
    certainty="analytic",
    why="rounding; the column bends by a millionth",
    picture=lambda: Picture(column(1.0, NUDGE)),
    seconds=0.3,
)
