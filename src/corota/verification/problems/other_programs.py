"""The same mesh in other programs: a cantilever with large rotations, in statics and dynamics.

10 x 1, thickness 0.01, E = 1.2e6, nu = 0.3, plane stress, four cells of Q4 across, the local strain
`green_lagrange`, which is the total-Lagrangian St. Venant-Kirchhoff solid. A dead shear of 4000 per
unit thickness in ten increments; and 1000 (or 2000) at once, unit density, 200 increments of 0.005
by the trapezoidal rule. Kratos, Akantu, DOLFINx, scikit-fem and FElupe gave the first to all digits
shown, DOLFINx the second (the others start without the load's acceleration).
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Picture, Problem, Value
from corota.verification.models import nearest, run

#: Cells across and displacement of the middle of the end (x, y) under the dead shear.
STATIC = {4: (-3.26267, 6.70523)}
#: Load a unit of thickness and largest displacement y of the middle of the end.
MOTION = {1000.0: 5.40408, 2000.0: 7.80065}


def cantilever(n: int, load: float) -> tuple[ct.Model, int]:
    """The cantilever; with the middle of its end."""
    mesh = ct.mesh.rectangle(10.0, 1.0, 10 * n, n)
    model = ct.Model(mesh)
    material = ct.Elastic(E=1.2e6, nu=0.3, rho=1.0)
    model.section(
        "all", element="Q4", material=material, thickness=0.01, local_strain="green_lagrange"
    )
    model.fix("left")
    model.traction("right", y=load)
    return model, nearest(mesh, 10.0, 0.5)


@cache
def bent(n: int, **keys: bool) -> tuple[ct.Results, int]:
    """At rest, ten increments."""
    model, tip = cantilever(n, 4000.0)
    return run(model, ct.Static(increments=10), **keys), tip


@cache
def moved(load: float) -> tuple[np.ndarray, np.ndarray]:
    """Times, and displacements y of the middle of the end."""
    model, tip = cantilever(4, load)
    step = ct.Dynamic(period=1.0, increments=200, scheme="newmark", mass="constant")
    frames = run(model, step).frames
    return np.array([f.time for f in frames]), np.array([f.U[tip, 1] for f in frames])


def measure() -> Iterator[Value]:
    """All of them, to the digits printed."""
    for n, exact in STATIC.items():
        results, tip = bent(n)
        for axis, known, found in zip("xy", exact, results.frames[-1].U[tip], strict=True):
            yield Value(
                f"displacement {axis} at rest, {10 * n} x {n}", known, found, 5.1e-6, "absolute"
            )
    for load, known in MOTION.items():
        yield Value(
            f"largest displacement y in motion, load {load:g}",
            known,
            moved(load)[1].max(),
            5.1e-6,
            "absolute",
        )


def curve() -> Curve:
    """Motion of the end."""
    series = {f"Q4, load {load:g}": moved(load) for load in MOTION}
    tops = [float(t[u.argmax()]) for t, u in series.values()]
    return Curve(
        "time",
        "displacement y of the end",
        series,
        {"DOLFINx, largest": (tops, list(MOTION.values()))},
    )


PROBLEM = Problem(
    title="The same mesh in other programs",
    group="properties of the method",
    source="Kratos, Akantu, DOLFINx, scikit-fem, FElupe run side by side by the benchmarks "
    "(benchmarks/README.md)",
    certainty="computed independently",
    why="half of the last digit printed",
    picture=lambda: Picture(bent(4, fields=True)[0], "S11"),
    seconds=1.0,
)
