"""Plane-strain plasticity patch: a unit cell strained step by step beyond yield, NAFEMS's path.

E = 250 GPa, nu = 0.25, yield stress 5 MPa, no hardening. The strains along x and y grow by 2.5e-5
twice each, then fall twice each, so that the direction of plastic flow changes. For a constant
strain rate the exact deviator rotates towards the rate by tan(psi/2) = tan(psi0/2) exp(-2 G |e| /
R) with the radius R of the yield surface (R. D. Krieg, D. B. Krieg, J. Pressure Vessel Technol. 99,
1977). Patches reproduce the stress of the material: the work of an increment is a convex,
continuously differentiable function of all displacements, including internal ones. The uniform
stress is therefore unique, although without hardening the displacements inside are not.
"""

# SPDX-License-Identifier: BSD-3-Clause
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import corota as ct
from corota.verification.catalogue import Curve, Problem, Value, zero
from corota.verification.models import boundary, cell, last_frames, prescribe, run

E, NU, YIELD, SIDE = 250e3, 0.25, 5.0, 2.5e-5
STEPS = np.array([(1, 0), (1, 0), (0, 1), (0, 1), (-1, 0), (-1, 0), (0, -1), (0, -1)]) * SIDE
#: Increments a step: backward Euler is of first order.
FINE, COARSE = 4000, 10


def exact() -> np.ndarray:
    """Stresses (xx, yy, zz) [MPa] after each step."""
    g, bulk, radius = E / (2 * (1 + NU)), E / (3 * (1 - 2 * NU)), np.sqrt(2 / 3) * YIELD
    s, volume, out = np.zeros(3), 0.0, []
    for ex, ey in STEPS:
        de = np.array([ex, ey, 0.0])
        volume += de.sum()
        de -= de.mean()
        trial = s + 2 * g * de
        if np.linalg.norm(trial) <= radius:
            s = trial
        else:
            # Elastic up to the surface, then along it.
            a, b, c = (2 * g) ** 2 * (de @ de), 4 * g * (s @ de), s @ s - radius**2
            part = max(0.0, (-b + np.sqrt(max(b * b - 4 * a * c, 0.0))) / (2 * a))
            s = s + 2 * g * part * de
            rest, way = (1 - part) * np.linalg.norm(de), de / np.linalg.norm(de)
            cosine = float(np.clip(s @ way / np.linalg.norm(s), -1.0, 1.0))
            across = s - (s @ way) * way
            psi = 2 * np.arctan(np.tan(0.5 * np.arccos(cosine)) * np.exp(-2 * g * rest / radius))
            size = np.linalg.norm(across)
            side = across / size if size > 1e-12 * radius else np.zeros(3)
            s = radius * (np.cos(psi) * way + np.sin(psi) * side)
        out.append(s + bulk * volume)
    return np.array(out)


def point(increments: int) -> np.ndarray:
    """Stresses (xx, yy) after each step by the material alone."""
    share = np.linspace(1.0 / increments, 1.0, increments)[:, None]
    start, rows = np.zeros(2), []
    for step in STEPS:
        rows.append(np.column_stack([start + step * share, np.zeros(increments)]))
        start = start + step
    answer = ct.Mises(E=E, nu=NU, yield_stress=YIELD).respond(np.concatenate(rows), "strain")
    return np.asarray(answer["stress"])[increments - 1 :: increments, :2]


def strained(model: ct.Model) -> ct.Results:
    """All steps of the path on the boundary of a model."""
    edge, total, steps = boundary(model.mesh), np.zeros(2), []
    for step in STEPS:
        total = total + step
        part = ct.Model(model.mesh)
        prescribe(part, edge, model.mesh.points[edge] * total)
        steps.append(ct.Static(nlgeom=False, increments=COARSE, supports=part.supports))
    return run(model, list(steps), fields=True)


def patch(element: str) -> np.ndarray:
    """Stresses (xx, yy) after each step of a distorted mesh whose boundary moves."""
    mesh = ct.mesh.distort(ct.mesh.rectangle(1.0, 1.0, 3, 3, cell(element)), 0.2, seed=1)
    model = ct.Model(mesh)
    model.section(
        "all", element=element, material=ct.Mises(E=E, nu=NU, yield_stress=YIELD), plane="strain"
    )
    frames = last_frames(strained(model))
    return np.array([f.fields[0].values["S"][..., :2].reshape(-1, 2) for f in frames])


def measure() -> Iterator[Value]:
    """The material's limit against the exact stress, and patches against the material."""
    reference, fine, coarse = exact(), point(FINE), point(COARSE)
    for k in range(len(STEPS)):
        for axis, name in enumerate(("xx", "yy")):
            yield Value(
                f"stress {name} after step {k + 1} [MPa]",
                reference[k, axis],
                fine[k, axis],
                1e-3,
                "absolute",
            )
    for element in ("Q4I", "T6", "Q8", "Q8R", "Q9"):
        worst = float(np.abs(patch(element) - coarse[:, None]).max())
        yield zero(f"patch of {element} beside the material [MPa]", worst, 1e-7)


def curve() -> Curve:
    """Stress along x, exact and with ten increments a step."""
    count = np.arange(1, len(STEPS) + 1)
    return Curve(
        "step",
        "stress along x [MPa]",
        {"exact": (np.append(0, count), np.append(0.0, exact()[:, 0]))},
        {"ten increments a step": (count, point(COARSE)[:, 0])},
    )


PROBLEM = Problem(
    title="Plane-strain plasticity patch",
    group="plasticity",
    source="NAFEMS, plane-strain plasticity benchmarks (path); stresses by Krieg and Krieg's exact "
    "integration",
    certainty="analytic",
    why="a thousandth of a megapascal at 4000 increments a step; patches: Newton's tolerance",
    seconds=0.8,
)
